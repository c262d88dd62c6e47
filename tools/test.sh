#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds and runs the tests. --quick leaves out the slow suites, which are those named Slow*. Tests that
# lack something (a browser, a Slurm cluster, $CHROMEBALL_DATA) are skipped; with --no-skips they have
# failed. Other arguments go to GoogleTest (--gtest_filter=PATTERN). The last line is "N passed, N failed".
set -euo pipefail
cd "$(dirname "$0")/.."

arguments=()
for argument in "$@"; do
  case $argument in
    --quick) arguments+=('--gtest_filter=-Slow*:*/Slow*') ;;
    *) arguments+=("$argument") ;;
  esac
done

tools/build.sh
exec tools/scripts/run_tests.sh build "${arguments[@]}"
