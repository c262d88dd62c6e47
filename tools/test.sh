#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds and runs the tests. --quick leaves out the slow suites, which are those named Slow*. Other
# arguments go to GoogleTest (--gtest_filter=PATTERN). The last line is "N passed, N failed".
set -euo pipefail
cd "$(dirname "$0")/.."

arguments=()
for argument in "$@"; do
  if [[ $argument == --quick ]]; then
    arguments+=('--gtest_filter=-Slow*:*/Slow*')
  else
    arguments+=("$argument")
  fi
done

tools/build.sh

status=0
build/tests "${arguments[@]}" | tee build/tests.log || status=$?
# GoogleTest's totals; a run that crashed prints none.
total() { sed -nE "s/^\[  $1  ?\] ([0-9]+) tests?[.,].*/\1/p" build/tests.log | tail -n 1; }
passed=$(total PASSED) failed=$(total FAILED)
if [[ -z $passed ]]; then
  echo "The tests stopped early (exit status $status)." >&2
  passed=$(grep -c '^\[       OK \]' build/tests.log || true) failed=${failed:-1}
fi
echo "$passed passed, ${failed:-0} failed"
exit "$status"
