#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Renders the still life under a probe with chromeball and with Cycles (Debian's Blender 3.4, which
# is installed if missing), and prints each one's error and time. See --help.
set -euo pipefail
cd "$(dirname "$0")/../.."

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

tools/build.sh
exec /usr/bin/python3 tools/scripts/versus_cycles.py "$@"
