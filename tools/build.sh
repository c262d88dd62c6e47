#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the packages that the build needs and this machine lacks (Debian and Ubuntu, as root or
# with sudo), then builds everything into build/, or one target (--target NAME). --packages-only stops
# after the packages. Other arguments go to the configure step (-DNAME=VALUE).
set -euo pipefail
cd "$(dirname "$0")/.."

target=()
build=1
if [[ ${1:-} == --target ]]; then
  target=(--target "$2")
  shift 2
elif [[ ${1:-} == --packages-only ]]; then
  build=0
fi

packages=(build-essential cmake pkg-config
  libembree-dev libpng-dev libjpeg-dev libopenexr-dev libopenimageio-dev libtinygltf-dev libdraco-dev libmeshoptimizer-dev libwebp-dev
  libtomlplusplus-dev libcli11-dev libcpp-httplib-dev libglm-dev libtbb-dev libfmt-dev
  nlohmann-json3-dev libeigen3-dev libboost-dev libgtest-dev libbenchmark-dev)

needs() {
  echo "chromeball needs these packages (Debian's names), and cannot install them here:" >&2
  echo "  $*" >&2
  exit 1
}

if command -v dpkg-query >/dev/null; then
  missing=()
  for package in "${packages[@]}"; do
    status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [[ $status == installed* ]] || missing+=("$package")
  done
  if ((${#missing[@]})); then
    asRoot=()
    if ((EUID != 0)); then
      if ! sudo -n true 2>/dev/null && ! { command -v sudo >/dev/null && [[ -t 0 ]]; }; then
        needs "${missing[@]}"
      fi
      asRoot=(sudo)
    fi
    echo "Installing ${missing[*]}"
    "${asRoot[@]}" apt-get update -q || true
    "${asRoot[@]}" env DEBIAN_FRONTEND=noninteractive \
      apt-get install -qy --no-install-recommends "${missing[@]}" || needs "${missing[@]}"
  fi
fi

((build)) || exit 0

# A compiler process may take 1.5 GiB.
memory=$(awk '/^MemAvailable/ { print int($2 / 1572864) }' /proc/meminfo 2>/dev/null || echo 1)
jobs=$(nproc 2>/dev/null || echo 1)
((jobs <= memory)) || jobs=$((memory > 0 ? memory : 1))

if ! cmake -S . -B build -DCMAKE_BUILD_TYPE=Release "$@"; then
  command -v dpkg-query >/dev/null || needs "${packages[@]}"
  exit 1
fi
cmake --build build --parallel "$jobs" "${target[@]}"
