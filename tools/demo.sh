#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the command and renders the demo scene to out/, denoised. Arguments go to `chromeball render`
# (--samples 32 for a quick look).
set -euo pipefail
cd "$(dirname "$0")/.."

tools/build.sh --target chromeball
mkdir -p out
build/chromeball render scenes/demo.toml --denoise -o out/demo.exr -o out/demo.png --tonemap neutral "$@"
echo "Wrote $PWD/out/demo.png (tone mapped) and $PWD/out/demo.exr (radiance; the image before" \
  "denoising is its layer noisy)"
