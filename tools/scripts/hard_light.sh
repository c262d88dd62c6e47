#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Renders caustics, glass and interiors in equal time: unguided, guided, regularized, denoised, and
# with Cycles (Debian's Blender 3.4, which is installed if missing). Prints their errors and makes a
# page of the images, out/hard-light/index.html. See --help; --no-cycles does without Blender.
set -euo pipefail
cd "$(dirname "$0")/../.."

[[ " $* " == *" --no-cycles "* ]] || source tools/scripts/need_blender.sh
tools/build.sh
exec /usr/bin/python3 tools/scripts/hard_light.py "$@"
