#!/usr/bin/env bash
# Builds and runs the tests; --quick leaves out the suites that take more than seconds. Other
# arguments go to ctest (-R REGEX runs the tests whose name matches).
set -euo pipefail
cd "$(dirname "$0")/.."

arguments=()
for argument in "$@"; do
  if [[ $argument == --quick ]]; then
    arguments+=(--exclude-regex '(^|/)Slow')
  else
    arguments+=("$argument")
  fi
done

tools/build.sh
ctest --test-dir build --parallel 2 --output-on-failure --no-tests=error "${arguments[@]}"
