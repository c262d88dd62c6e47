#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks docs/orientation.md's row about Blender: renders a probe behind nothing with Cycles (Debian's
# Blender 3.4, which is installed if missing) and with chromeball, and prints how they differ for
# several rotations of Blender's Mapping node. Ends with status 1 if one differs.
set -euo pipefail
cd "$(dirname "$0")/../.."

source tools/scripts/need_blender.sh
tools/build.sh
exec /usr/bin/python3 tools/scripts/blender_orientation.py "$@"
