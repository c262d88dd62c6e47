#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Compares the speed and the memory of this program with those of another commit, which is built in
# build/versus: versus_commit.sh COMMIT [OPTIONS]. See --help.
set -euo pipefail
cd "$(dirname "$0")/../.."

commit=$(git rev-parse --short=12 "${1:?a commit, such as HEAD~10}^{commit}")
shift
tools/build.sh
other=$PWD/build/versus/$commit
if [[ ! -x $other/build/chromeball ]]; then
  mkdir -p "$other"
  git archive "$commit" | tar x -C "$other"
  "$other/tools/build.sh" --target chromeball
fi
exec python3 tools/scripts/versus_commit.py "$other/build/chromeball" "$@"
