#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Tests the Python module of a build: test_python.sh BUILD_FOLDER. Writes BUILD_FOLDER/tests-python.txt, and prints
# "PASSED FAILED", then lines "NAME: REASON" of what was skipped. Prints "0 0" for a build without the module.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=$(realpath "$1")
log=$build/tests-python.txt

rm -f "$log"
compgen -G "$build/python/chromeball/_core*.so" >/dev/null || { echo "0 0"; exit; }
python=$(sed -n 's/^_Python_EXECUTABLE:[A-Z]*=//p' "$build/CMakeCache.txt")
if ! "$python" -c 'import numpy, pytest' 2>/dev/null; then
  echo "0 0"
  echo "Python: $python has no numpy or no pytest"
  exit
fi
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$build/python CHROMEBALL_COMMAND=$build/chromeball \
  "$python" -m pytest -q -rs -p no:cacheprovider python/tests >"$log" 2>&1 || true
count() { sed -nE "\$s/.*\b([0-9]+) $1.*/\1/p" "$log" | grep . || echo 0; }
failed=$(($(count failed) + $(count error)))
passed=$(count passed)
((passed + failed)) || failed=1  # it did not run
echo "$passed $failed"
sed -nE 's/^SKIPPED \[[0-9]+\] ([^:]+):[0-9]+: (.*)/\1: \2/p' "$log"
