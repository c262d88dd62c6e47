#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks the format of all C++ files (clang-format 14, .clang-format), and runs the checks of .clang-tidy
# (clang-tidy 14) on files of renderer/ and tools/: those that the changes since the commit in
# tools/linted_commit, whose files all passed, may have made faulty (see tools/scripts/lint_selection.sh).
# Installs both tools where they are missing (Debian and Ubuntu, as root or with sudo).
#   --all      clang-tidy looks at all files, in the groups that are compiled together (tools/cmake/unity.cmake),
#              in about five minutes on two cores; if all pass, the current commit is written to
#              tools/linted_commit
#   --format   the format only
#   --fix      formats the files instead
set -euo pipefail
cd "$(dirname "$0")/.."

tidy=1 fix=0 all=0
for argument in "$@"; do
  case $argument in
    --all) all=1 ;;
    --format) tidy=0 ;;
    --fix) fix=1 tidy=0 ;;
    *)
      sed -n '3,11s/^# \{0,1\}//p' "$0" >&2
      exit 2
      ;;
  esac
done
fail() {
  echo "lint: $*" >&2
  exit 1
}

tools=(clang-format-14)
((!tidy)) || tools+=(clang-tidy-14)
missing() {
  local tool
  for tool in "${tools[@]}"; do command -v "$tool" >/dev/null || echo "$tool"; done
}
if [[ -n $(missing) ]]; then
  source tools/scripts/packages.sh
  installPackages "${tools[@]}" || true
  [[ -z $(missing) ]] || fail "cannot run without $(missing | xargs)"
fi

# The files to check; without Git (an unpacked archive), all but generated folders.
hasGit() { git rev-parse --git-dir >/dev/null 2>&1; }
sources() {
  if hasGit; then
    git ls-files --cached --others --exclude-standard -- '*.h' '*.cpp'
  else
    find renderer python tools tests -name '*.h' -o -name '*.cpp'
  fi
}
mapfile -t files < <(sources)
if ((fix)); then
  clang-format-14 -i "${files[@]}"
  exit
fi

echo "Checking the format of ${#files[@]} files"
printf '%s\0' "${files[@]}" | xargs -0 -n 50 -P "$(nproc)" clang-format-14 --dry-run --Werror ||
  fail "the format differs from .clang-format; run tools/lint.sh --fix"
((tidy)) || exit 0

# Without the history, and with a shallow clone's part of it, changes are unknown.
wasAll=$all
[[ $(git rev-parse --is-shallow-repository 2>/dev/null) == false ]] || all=1
# Configured only, without precompiled headers, since GCC's are of no use to clang-tidy.
configure() {
  cmake -S . -B build/lint -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DCHROMEBALL_UNITY="$1" \
    -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DCHROMEBALL_TESTS=OFF >/dev/null
  # Options of GCC's that clang-tidy refuses.
  sed -i -E 's/-mmem(cpy|set)-strategy=[^ "]*//g' build/lint/compile_commands.json
}
if ((all)); then
  configure ON
  selected=$(sed -nE 's/^ *"file": "(.*)",?$/\1/p' build/lint/compile_commands.json)
else
  selected=$(tools/scripts/lint_selection.sh)
  [[ -n $selected ]] || { echo "lint: no faults"; exit; }
  configure OFF
fi
selected=$(sort -r <<<"$selected")  # those of tools/command, which take longest, first

echo "Running clang-tidy on $(wc -l <<<"$selected") files"
log=build/lint/clang-tidy.log
# Each process writes at its end, so that the lines of two do not mix.
if ! xargs -d '\n' -n 1 -P "$(nproc)" sh -c \
  'found=$(clang-tidy-14 -quiet -p build/lint --header-filter="/(renderer|tools)/.*\.(h|cpp)$" "$1" 2>&1) || { echo "$found"; exit 1; }' - \
  <<<"$selected" >"$log"; then
  grep -E -A4 '(error|warning): ' "$log" | sort -u >&2 || tail -n 20 "$log" >&2
  fail "clang-tidy found faults (all of it: $log)"
fi

if ((wasAll)) && hasGit; then
  if [[ -z $(git status --porcelain -- '*.h' '*.cpp' '*.clang-tidy') ]]; then
    git rev-parse HEAD >tools/linted_commit
    echo "Wrote tools/linted_commit: commit it"
  else
    echo "tools/linted_commit is as it was, since there are changes that are not committed"
  fi
fi
echo "lint: no faults"
