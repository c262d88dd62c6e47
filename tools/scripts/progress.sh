#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Reads the output of a build by Make or Ninja, and prints its progress in one line: the share of the
# steps that are done, the time since the start, and about the time left, at the speed since the first
# step that compiled. On a terminal the line is rewritten, elsewhere there is one a minute
# ($CHROMEBALL_PROGRESS_EVERY seconds). What is no step (errors, warnings) is printed in full, to
# standard error.
set -uo pipefail

terminal=0
[[ ! -t 1 || ${TERM:-dumb} == dumb ]] || terminal=1
every=${CHROMEBALL_PROGRESS_EVERY:-$((terminal ? 1 : 60))}

# Hundredths of a second, of a clock that nobody sets.
now() {
  if read -r clock _ </proc/uptime; then clock=$((10#${clock/./})); else clock=$((SECONDS * 100)); fi
} 2>/dev/null
minutes() { printf -v "$1" '%d:%02d' $(($2 / 6000)) $(($2 / 100 % 60)); }

now
start=$clock shown=$clock
# In thousandths of the whole: now, and at the first step that compiled; and when that was.
share=0 firstShare=-1 firstTime=0

show() {
  local passed left line
  shown=$clock
  minutes passed $((clock - start))
  line="$((share / 10)) % built, $passed min"
  # Early guesses are far off.
  if ((share < 1000 && firstShare >= 0 && share - firstShare >= 20 && clock - firstTime >= 500)); then
    minutes left $(((clock - firstTime) * (1000 - share) / (share - firstShare)))
    line+=", about $left min left"
  fi
  if ((terminal)); then printf '\r\e[K%s' "$line"; else echo "$line"; fi
}
pass() {
  ((!terminal)) || printf '\r\e[K'
  printf '%s\n' "$1" >&2
}

handle() {
  if [[ $1 =~ ^\[\ *([0-9]+)%\]\ (.*) ]]; then
    share=$((10#${BASH_REMATCH[1]} * 10))
  elif [[ $1 =~ ^\[([0-9]+)/([0-9]+)\]\ (.*) ]]; then
    share=$((10#${BASH_REMATCH[1]} * 1000 / 10#${BASH_REMATCH[2]}))
  else
    # Make's and CMake's notes.
    [[ $1 =~ ^(--\ |Consolidate\ compiler\ generated|Scanning\ dependencies|Dependencies\ file) ]] ||
      pass "$1"
    return
  fi
  if ((firstShare < 0)) && [[ ${BASH_REMATCH[-1]} == Building\ * ]]; then
    firstShare=$share firstTime=$clock
  fi
}

# A line may come in parts, since read gives up after a while to let the time be shown.
line=
while true; do
  IFS= read -r -t 1 part
  status=$?
  line+=$part
  now
  if ((status == 0)); then
    handle "$line"
    line=
  elif ((status <= 128)); then
    break
  fi
  ((clock - shown < every * 100)) || show
done
[[ -z $line ]] || handle "$line"
if ((firstShare >= 0)); then
  show
  ((!terminal)) || echo
fi
