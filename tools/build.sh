#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the packages that the build needs and this machine lacks (Debian and Ubuntu, as root or
# with sudo), then builds everything into build/, or one target (--target NAME). --packages-only stops
# after the packages; --verbose, or V=1, shows every command instead of the progress. Other arguments
# go to the configure step (-DNAME=VALUE).
set -euo pipefail
cd "$(dirname "$0")/.."

target=() build=1 verbose=${V:-} options=()
while (($#)); do
  case $1 in
    --target) target=(--target "${2:?the name of a target}"); shift ;;
    --packages-only) build=0 ;;
    --verbose) verbose=1 ;;
    *) options+=("$1") ;;
  esac
  shift
done

packages=(build-essential cmake pkg-config
  libembree-dev libpng-dev libjpeg-dev libopenexr-dev libopenimageio-dev libtinygltf-dev libdraco-dev libmeshoptimizer-dev libwebp-dev
  libblosc-dev libxxhash-dev
  libtomlplusplus-dev libcli11-dev libcpp-httplib-dev libglm-dev libtbb-dev libfmt-dev
  nlohmann-json3-dev libeigen3-dev libboost-dev libgtest-dev libbenchmark-dev)

source tools/scripts/packages.sh
installPackages "${packages[@]}"
((build)) || exit 0

# A compiler process may take 1.5 GiB.
memory=$(awk '/^MemAvailable/ { print int($2 / 1572864) }' /proc/meminfo 2>/dev/null || echo 1)
jobs=$(nproc 2>/dev/null || echo 1)
((jobs <= memory)) || jobs=$((memory > 0 ? memory : 1))

configure=(cmake -S . -B build -DCMAKE_BUILD_TYPE=Release "${options[@]}")
make=(cmake --build build --parallel "$jobs" "${target[@]}")
if [[ -n $verbose ]]; then
  "${configure[@]}" && "${make[@]}" --verbose
  exit
fi
# Warnings and errors are on standard error.
if ! "${configure[@]}" >/dev/null; then
  command -v dpkg-query >/dev/null ||
    echo "chromeball needs these packages (Debian's names): ${packages[*]}" >&2
  exit 1
fi
"${make[@]}" 2>&1 | tools/scripts/progress.sh
