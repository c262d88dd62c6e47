#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Prints which .cpp files below renderer/ and tools/ of the project in the current folder clang-tidy is to
# look at after the changes since the commit in tools/linted_commit, whose files all passed; the changes may
# be committed or not:
#
#   tools/scripts/lint_selection.sh [LIMIT]
#
#   - every .cpp file that has changed,
#   - for each header that has changed and that none of these includes, itself or through other headers, one
#     .cpp file that does: clang-tidy reports a header's own faults wherever it is included,
#   - and of the other .cpp files that include a changed header, for what its declarations make wrong in
#     them, so many that the list has LIMIT files (100): those nearest to the header first, and of equally
#     near ones one of each folder in turn.
#
# Standard error says how many more include a changed header; tools/lint.sh --all looks at them too. If
# .clang-tidy has changed, all files are printed. Status 1 if the commit is not in the history, or more than
# 100 commits back.
set -euo pipefail
export LC_ALL=C
limit=${1:-100} commit=$(cat tools/linted_commit)

fail() {
  echo "lint: commit $commit (tools/linted_commit) is $*" >&2
  exit 1
}
if ! git merge-base --is-ancestor "$commit" HEAD 2>/dev/null; then
  [[ $(git rev-parse --is-shallow-repository) == false ]] ||
    fail "not in this shallow clone; run git fetch --unshallow, or tools/lint.sh --all"
  fail "not in the history; run tools/lint.sh --all, and commit what it writes"
fi
(($(git rev-list --count "$commit..HEAD") <= 100)) ||
  fail "more than 100 commits back; run tools/lint.sh --all, and commit what it writes"

changed() {
  git diff --relative --name-only --diff-filter=d "$commit" -- "$@"
  git ls-files --others --exclude-standard -- "$@"
}
if [[ -n $(changed '*.clang-tidy') ]]; then
  find renderer tools -name '*.cpp'
  exit
fi

# FILE HEADER, as the file writes it.
includes() {
  grep -rHoE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"[^"]+"' --include='*.h' --include='*.cpp' \
    renderer tools | sed -E 's/^([^:]*):.*"(.*)"$/\1 \2/'
}

# Reads changed files (one word a line) and includes() (two). Prints DISTANCE FILE: how many #includes away
# the nearest changed header is; 0 for the files that must be looked at.
distances() {
  awk '
    NF == 1 { changed[++count] = $1; known[$1]; next }
    { from[++edges] = $1; to[edges] = $2; known[$1] }

    # The file that `file` means by #include "header"; "" if it neither has changed nor includes another.
    function resolved(file, header, i) {
      sub(/[^\/]*$/, "", file)
      root[1] = file
      for (i = 1; i <= 4; ++i) if (root[i] header in known) return root[i] header
      return ""
    }
    # Breadth first, from a header to all that include it: sets distance[], nearest and covered.
    function walk(header, queue, steps, file, head, tail, parts, i) {
      nearest = ""
      covered = 0
      steps[queue[tail = 1] = header] = 0
      for (head = 1; head <= tail; ++head)
        for (i = split(includers[queue[head]], parts); i > 0; --i) {
          file = parts[i]
          if (file in steps) continue
          steps[queue[++tail] = file] = steps[queue[head]] + 1
          if (file !~ /\.cpp$/) continue
          if (!(file in distance) || steps[file] < distance[file]) distance[file] = steps[file]
          if (distance[file] == 0) covered = 1
          if (nearest == "" || (steps[file] == steps[nearest] && file < nearest)) nearest = file
        }
    }

    END {
      split("- renderer/ tools/ tools/command/", root)
      for (i = 1; i <= edges; ++i) includers[resolved(from[i], to[i])] = \
        includers[resolved(from[i], to[i])] " " from[i]
      for (i = 1; i <= count; ++i) if (changed[i] ~ /\.cpp$/) distance[changed[i]] = 0
      for (i = 1; i <= count; ++i)
        if (changed[i] ~ /\.h$/) {
          walk(changed[i])
          if (!covered && nearest != "") distance[nearest] = 0
        }
      for (file in distance) print distance[file], file
    }'
}

{ changed 'renderer/*.h' 'renderer/*.cpp' 'tools/*.h' 'tools/*.cpp' | sort; includes; } | distances |
  sort -k 1,1n -k 2 |
  awk '{ folder = $2; sub(/[^\/]*$/, "", folder); print $1, ++place[$1, folder], $2 }' |
  sort -k 1,1n -k 2,2n -k 3 |
  awk -v limit="$limit" '
    $1 == 0 || NR <= limit { print $3; next }
    { ++others }
    END { if (others) print others " more files include a changed header" >"/dev/stderr" }'
