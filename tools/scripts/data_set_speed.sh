#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Renders the views of a data set with chromeball's Python module, Mitsuba 3 and Cycles (from PyPI, installed
# into build/data-set-speed if missing), one after the other, and prints each one's time. See --help.
set -euo pipefail
cd "$(dirname "$0")/../.."

tools/build.sh
venv=build/data-set-speed/venv
if ! "$venv/bin/python" -c 'import mitsuba, bpy' 2>/dev/null; then
  python3 -m venv "$venv"
  "$venv/bin/pip" install -q --disable-pip-version-check numpy mitsuba==3.9.1 bpy==5.0.1
fi
exec python3 tools/scripts/data_set_speed/main.py --python "$venv/bin/python" "$@"
