#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes docs/capture.md and its pictures: from photographs of balls to a composite, with the error of each
# step against a known truth. Takes some minutes on two cores. The part with real photographs needs
# $CHROMEBALL_DATA; without it the text of an earlier run stays. --out FOLDER writes elsewhere, this text too.
set -euo pipefail
cd "$(dirname "$0")/../.."

[[ -x build/chromeball ]] || tools/build.sh
exec env PYTHONPATH=tools/scripts/shared python3 tools/scripts/capture_tutorial/main.py "$@"
