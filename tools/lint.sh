#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks the format of all C++ files (clang-format 14, .clang-format) and runs the checks of
# .clang-tidy (clang-tidy 14) on renderer/ and tools/, after installing both where they are missing
# (Debian and Ubuntu, as root or with sudo). --fix formats the files instead; --format leaves out
# clang-tidy, which takes minutes.
set -euo pipefail
cd "$(dirname "$0")/.."

tidy=1 fix=0
for argument in "$@"; do
  case $argument in
    --format) tidy=0 ;;
    --fix) fix=1 tidy=0 ;;
    *)
      sed -n '3,6s/^# \{0,1\}//p' "$0" >&2
      exit 2
      ;;
  esac
done

tools=(clang-format-14)
((!tidy)) || tools+=(clang-tidy-14 run-clang-tidy-14)
missing() {
  local tool
  for tool in "${tools[@]}"; do command -v "$tool" >/dev/null || echo "$tool"; done
}
if [[ -n $(missing) ]]; then
  asRoot=()
  ((EUID == 0)) || asRoot=(sudo -n)
  packages=(clang-format-14)
  ((!tidy)) || packages+=(clang-tidy-14)
  echo "Installing ${packages[*]}"
  "${asRoot[@]}" apt-get update -q || true
  "${asRoot[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -qy --no-install-recommends "${packages[@]}" || true
fi
if [[ -n $(missing) ]]; then
  echo "lint: cannot run and cannot install: $(missing | xargs)" >&2
  exit 1
fi

# Without Git (an unpacked archive): all but generated folders.
sources() {
  git ls-files --cached --others --exclude-standard -- '*.h' '*.cpp' 2>/dev/null ||
    find renderer tools tests -name '*.h' -o -name '*.cpp'
}
mapfile -t files < <(sources)
if ((fix)); then
  clang-format-14 -i "${files[@]}"
  exit
fi

echo "Checking the format of ${#files[@]} files"
if ! clang-format-14 --dry-run --Werror "${files[@]}"; then
  echo "lint: the format differs from .clang-format; run tools/lint.sh --fix" >&2
  exit 1
fi

if ((tidy)); then
  echo "Running clang-tidy"
  # Configured only. No precompiled headers, since GCC's are of no use to clang-tidy.
  cmake -S . -B build/lint -DCMAKE_EXPORT_COMPILE_COMMANDS=ON \
    -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DCHROMEBALL_TESTS=OFF >/dev/null
  log=build/lint/clang-tidy.log
  if ! run-clang-tidy-14 -quiet -p build/lint -j "$(nproc)" '/(renderer|tools)/.*\.cpp$' \
    >"$log" 2>&1; then
    grep -E -A4 '(error|warning): ' "$log" | sort -u >&2 || tail -n 20 "$log" >&2
    echo "lint: clang-tidy found faults (all of it: $log)" >&2
    exit 1
  fi
fi
echo "lint: no faults"
