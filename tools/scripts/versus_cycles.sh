#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Renders the still life under a probe with chromeball and with Cycles (Debian's Blender 3.4, which
# is installed if missing), and prints each one's error and time. See --help.
set -euo pipefail
cd "$(dirname "$0")/../.."

source tools/scripts/need_blender.sh
tools/build.sh
exec /usr/bin/python3 tools/scripts/versus_cycles.py "$@"
