#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds and renders the demo scene. Arguments go to `chromeball render` (--samples 32: a quick look).
set -euo pipefail
cd "$(dirname "$0")/.."

tools/build.sh --target chromeball
mkdir -p out
build/chromeball render scenes/demo.toml -o out/demo.exr -o out/demo.png --tonemap neutral "$@"
echo "The pictures: $PWD/out/demo.png (tone mapped), $PWD/out/demo.exr (radiance)"
