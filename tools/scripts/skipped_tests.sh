#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Prints which tests were skipped, and why, from the output of GoogleTest in files: "NAME: REASON".
set -euo pipefail

awk '
  /^\[ RUN      \] / { reason = ""; skips = 0 }
  skips && /^\[  SKIPPED \] / { sub(/,$/, "", $4); print $4 ": " (reason == "" ? "no reason given" : reason); skips = 0 }
  skips { reason = reason (reason == "" ? "" : " ") $0 }
  /: Skipped$/ { skips = 1 }' "$@"
