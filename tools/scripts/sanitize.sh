#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs all tests, and the commands that they start, under sanitizers, in builds of its own (presets asan
# and tsan; tests/ENVELOPE.md):
#   sanitize.sh address [GOOGLETEST ARGUMENT...]  AddressSanitizer, LeakSanitizer and UBSan
#   sanitize.sh thread [GOOGLETEST ARGUMENT...]   ThreadSanitizer, with an instrumented oneTBB
#   sanitize.sh status                            when each last passed
# The last line is "N passed, N failed"; a report of a sanitizer, which is shown, counts as a failed test.
# If none failed, tests/sanitizers/passed.txt says so, by sanitizer and arguments, to be committed. The
# packages are those that tools/build.sh installs.
set -euo pipefail
cd "$(dirname "$0")/../.."
record=tests/sanitizers/passed.txt

# oneTBB from Debian's sources, instrumented: ThreadSanitizer must see how it synchronises threads.
buildOneTbb() {  # FOLDER
  local work=$1
  [[ -e $work/libtbb.so.12 ]] && return
  mkdir -p "$work"/{parts,lists}
  sed 's/^Types: deb$/Types: deb-src/' /etc/apt/sources.list.d/debian.sources >"$work/parts/src.sources"
  local apt=(apt-get -o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts="$work/parts"
    -o Dir::State::lists="$work/lists")
  "${apt[@]}" update -q
  (cd "$work" && "${apt[@]}" source -q --download-only onetbb && tar xf onetbb_*.orig.tar.*)
  cmake -S "$work"/oneTBB-* -B "$work/build" -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBB_SANITIZE=thread \
    -DCMAKE_BUILD_TYPE=RelWithDebInfo >/dev/null
  cmake --build "$work/build" --parallel "$(nproc)" --target tbb
  cp "$(find "$work/build" -name libtbb.so.12)" "$work/"
}

# Replaces the paragraph of this sanitizer and these arguments.
writeRecord() {  # NAME COMMIT PASSED SKIPPED_TESTS
  local rest
  rest=$(awk -v name="$1:" 'BEGIN { RS = ""; ORS = "\n\n" } index($0, name) != 1' "$record")
  {
    [[ -z $rest ]] || printf '%s\n\n' "$rest"
    echo "$1: $3 passed, $(date +%F), commit $2"
    [[ -z $4 ]] || sed 's/^/  left out: /' <<<"$4"
  } >"$record.new"
  mv "$record.new" "$record"
}

mode=${1:?address, thread or status}
shift
case $mode in
  address) preset=asan ;;
  thread) preset=tsan ;;
  status)
    grep -v '^ ' "$record" | while read -r line; do
      [[ -z $line || $line == '#'* ]] ||
        echo "$line, $(git rev-list --count "${line##* }..HEAD") commits ago"
    done
    exit
    ;;
  *)
    echo "address, thread or status, not $mode" >&2
    exit 2
    ;;
esac

commit=$(git rev-parse --short=12 HEAD)
git diff --quiet HEAD -- CMakeLists.txt renderer tools tests ":!$record" || commit+="+changes"
build=$PWD/build/$mode
suppressions=$PWD/tests/sanitizers
if [[ $mode == thread ]]; then
  buildOneTbb "$build/onetbb"
  export LD_LIBRARY_PATH=$build/onetbb
fi
cmake --preset "$preset" >/dev/null
cmake --build "$build" --parallel "$(nproc)" --target tests

# Reports go to files: tests redirect the standard error of commands, which would hide them. (GCC's UBSan
# has no such option; its findings end the process, so that the test fails.)
reports=$build/reports
rm -rf "$reports"
mkdir -p "$reports"
export ASAN_OPTIONS=log_path=$reports/report
export LSAN_OPTIONS=suppressions=$suppressions/leak.txt:print_suppressions=0
export UBSAN_OPTIONS=print_stacktrace=1
# A long history: a report whose earlier stack is forgotten cannot be told from a suppressed one.
export TSAN_OPTIONS=suppressions=$suppressions/thread.txt:log_path=$reports/report:history_size=7

tools/scripts/run_tests.sh "$build" "$@" | tee "$build/tests.log" || true
read -r passed _ failed _ < <(tail -n 1 "$build/tests.log")
for report in "$reports"/*; do
  [[ -e $report ]] || continue
  cat "$report" >&2
  failed=$((failed + 1))
done
if ((failed == 0 && passed > 0)) && [[ $commit != *+changes ]]; then
  writeRecord "$mode, ${*:-all tests}" "$commit" "$passed" \
    "$(tools/scripts/skipped_tests.sh "$build"/tests-*.log)"
fi
echo "$passed passed, $failed failed"
((failed == 0))
