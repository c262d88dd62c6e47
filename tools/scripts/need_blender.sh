# SPDX-License-Identifier: Apache-2.0
# Sourced by the comparisons with Cycles: installs Debian's Blender 3.4 and NumPy if missing.
if ! command -v blender >/dev/null || ! /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
  asRoot=()
  ((EUID == 0)) || asRoot=(sudo)
  "${asRoot[@]}" apt-get update -q || true
  if ! "${asRoot[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -qy --no-install-recommends blender python3-numpy; then
    echo "This comparison needs Debian 12's packages blender and python3-numpy." >&2
    exit 1
  fi
fi
