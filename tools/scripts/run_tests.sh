#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the tests of a build: run_tests.sh BUILD_FOLDER [--no-skips] [GOOGLETEST ARGUMENT...]. Tests that
# lack something are skipped, and named with the reason; with --no-skips they have failed. The Python module's
# tests run too if it was built, unless a filter names what is wanted. Writes BUILD_FOLDER/tests-*.log. The
# last line is "N passed, N failed".
set -euo pipefail
scripts=$(cd "$(dirname "$0")" && pwd)
build=$1
shift

arguments=() maySkip=1
for argument in "$@"; do
  case $argument in
    --no-skips) maySkip=0 ;;
    *) arguments+=("$argument") ;;
  esac
done

# A process on each core, up to four, runs its part of the tests: many tests use one thread.
processes=$(nproc 2>/dev/null || echo 1)
((processes <= 4)) || processes=4
run() { GTEST_TOTAL_SHARDS=$processes GTEST_SHARD_INDEX=$1 "$build/tests" "${arguments[@]}"; }

rm -f "$build"/tests-*.log
begin=$SECONDS
running=()
for ((part = 0; part < processes; ++part)); do
  (run "$part" | tee "$build/tests-$part.log") &
  running+=($!)
done
status=0
for process in "${running[@]}"; do wait "$process" || status=$?; done

# The sum of GoogleTest's totals; a part that crashed prints none.
total() {
  sed -nE "s/^\[  $1  ?\] ([0-9]+) tests?[.,].*/\1/p" "$build"/tests-*.log |
    awk '{ sum += $1 } END { print sum + 0 }'
}
passed=$(total PASSED) failed=$(total FAILED)
if (($(grep -l '^\[  PASSED  \]' "$build"/tests-*.log | wc -l) < processes)); then
  echo "The tests stopped early (exit status $status)." >&2
  passed=$(cat "$build"/tests-*.log | grep -c '^\[       OK \]' || true)
  ((failed)) || failed=1
fi
skipped=$("$scripts/skipped_tests.sh" "$build"/tests-*.log)
if [[ "${arguments[*]}" != *--gtest_filter=[^-]* ]]; then
  python=$("$scripts/test_python.sh" "$build")
  read -r pythonPassed pythonFailed <<<"$python"
  ((passed += pythonPassed, failed += pythonFailed)) || true
  skipped+=$(tail -n +2 <<<"$python")
  if ((pythonFailed)); then
    cat "$build/tests-python.txt"
    status=1
  fi
fi
if [[ -n $skipped ]]; then
  echo "Skipped (tools/scripts/test_needs.sh installs what most tests need):"
  echo "$skipped"
  if ((!maySkip)); then
    failed=$((failed + $(wc -l <<<"$skipped")))
    status=1
  fi
fi
echo "The tests took $((SECONDS - begin)) s."
echo "$passed passed, $failed failed"
exit "$status"
