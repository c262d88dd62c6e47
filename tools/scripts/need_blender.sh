# SPDX-License-Identifier: Apache-2.0
# Sourced by the comparisons with Cycles: installs Debian's Blender 3.4 and NumPy if missing.
source tools/scripts/packages.sh
installPackages blender python3-numpy
if ! command -v blender >/dev/null; then
  echo "This comparison needs Debian 12's packages blender and python3-numpy." >&2
  exit 1
fi
# Blender takes the modules of the first python3 in the PATH: it must be Debian's, which has NumPy.
export PATH=/usr/bin:$PATH
