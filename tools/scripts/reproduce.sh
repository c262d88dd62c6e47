#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes docs/measured/reproduction.md and its pictures: what the HDRI book's chapter on image-based lighting,
# Madsen and Laursen (2007) and Madsen et al. (2003) show, beside what this program computes. Takes
# some minutes on two cores. Probes that are not in $CHROMEBALL_DATA are left out, with a note.
# --out FOLDER writes elsewhere.
set -euo pipefail
cd "$(dirname "$0")/../.."

tools/build.sh
exec env PYTHONPATH=tools/scripts/shared python3 tools/scripts/reproduction/main.py "$@"
