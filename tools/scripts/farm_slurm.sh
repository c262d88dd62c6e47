#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Renders a scene on a Slurm cluster: a job array of shards, and a job that merges them; a job array
# of frames; or of shards of frames, and an array that merges each frame.
#
#   tools/scripts/farm_slurm.sh SCENE --shards N -o OUT.exr [-o OUT.png] [--sbatch OPTIONS] [-- RENDER OPTIONS]
#   tools/scripts/farm_slurm.sh SCENE --frames A:B[:STEP] [--shards N] -o frame.####.exr ...
#
# The parts go to the folder OUT.parts, which all machines must share with the scene and the program.
# A task that is preempted, killed or requeued goes on from its checkpoint there; one that fails is
# tried three times. The last job merges what there is, or says what is missing: then call this
# again with the same arguments, which renders only that. Of whole frames, the folder has only
# checkpoints and logs.
#   --sbatch "..."    options for each task: "--cpus-per-task=32 --time=8:00:00 --partition=preempt"
# Prints the ids of the jobs. $CHROMEBALL names the program (default: this build's).
set -euo pipefail

usage() { sed -n '6,16s/^# \{0,1\}//p' "$0" >&2; exit 2; }
fail() { echo "farm_slurm.sh: $*" >&2; exit 2; }

chromeball=${CHROMEBALL:-$(cd "$(dirname "$0")/../.." && pwd)/build/chromeball}
scene='' shards='' frames='' outputs=() sbatch=() options=()
while (($#)); do
  case $1 in
    --shards) shards=${2:?}; shift 2 ;;
    --frames) frames=${2:?}; shift 2 ;;
    -o|--output) outputs+=("$(realpath -m "${2:?}")"); shift 2 ;;
    --sbatch) read -ra sbatch <<< "${2:?}"; shift 2 ;;
    --) shift; options=("$@"); break ;;
    -*) usage ;;
    *) [[ -z $scene ]] || usage; scene=$(realpath "$1"); shift ;;
  esac
done
[[ -n $scene && ${#outputs[@]} -gt 0 ]] || usage
[[ -n $shards || -n $frames ]] || usage
[[ -z $shards || $shards =~ ^[1-9][0-9]*$ ]] || fail "--shards: give the number of parts"
first=0 step=1 count=1
if [[ -n $frames ]]; then
  [[ $frames =~ ^([0-9]+):([0-9]+)(:([1-9][0-9]*))?$ ]] || fail "--frames: give FIRST:LAST[:STEP]"
  first=$((10#${BASH_REMATCH[1]})) last=$((10#${BASH_REMATCH[2]})) step=${BASH_REMATCH[4]:-1}
  ((first <= last)) || fail "--frames: give FIRST:LAST[:STEP]"
  count=$(((last - first) / step + 1))
  for output in "${outputs[@]}"; do
    [[ $output == *\#* ]] || fail "$output has no # for the number of the frame, as in frame.####.exr"
  done
fi
[[ -x $chromeball ]] || fail "$chromeball: not found; build it, or set CHROMEBALL"
command -v sbatch >/dev/null || fail "sbatch: not found; this needs Slurm"

parts=${outputs[0]%.*} parts=${parts//#/} parts=${parts%.}.parts
mkdir -p "$parts"
quoted() { printf '%q ' "$@"; }

results=()
for output in "${outputs[@]}"; do results+=(-o "$output"); done

# For both scripts: the number of the frame, and the outputs, numbered.
common="#!/usr/bin/env bash
folder=$(quoted "$parts")
outputs=($(quoted "${outputs[@]}"))
setFrame() {
  frame=\$(($first + \$1 * $step))
  for i in \"\${!outputs[@]}\"; do
    if [[ -n '$frames' && \${outputs[i]} =~ ^(|.*[^#])(#+)([^#]*)$ ]]; then
      printf -v \"outputs[i]\" '%s%0*d%s' \"\${BASH_REMATCH[1]}\" \${#BASH_REMATCH[2]} \$frame \"\${BASH_REMATCH[3]}\"
    fi
  done
}"
# Which image a task renders. It leaves one that is complete alone.
if [[ -z $shards ]]; then
  choice="setFrame \$SLURM_ARRAY_TASK_ID
what=($(quoted "${results[@]}"))"
else
  choice="setFrame \$((SLURM_ARRAY_TASK_ID / $shards))
shard=\$((SLURM_ARRAY_TASK_ID % $shards + 1))
part=\$folder/part-\$shard
[[ -e \$part${frames:+.\$frame}.exr ]] && exit 0
what=(--shard \$shard/$shards -o \"\$part${frames:+.#}.exr\")"
fi
# A frame that exists is left alone, as by the program.
[[ -z $frames ]] || choice+="
[[ -e \${outputs[0]} ]] && exit 0
what+=(--frames $frames --frame \$frame)"
# Exit status 2 is an error of the input, which another attempt does not mend.
task="$common
$choice
checkpoint=\$folder/task-\$SLURM_ARRAY_TASK_ID.checkpoint
for attempt in 1 2 3; do
  status=0
  $(quoted "$chromeball" render "$scene") \"\${what[@]}\" --checkpoint \"\$checkpoint${frames:+.#}.exr\" \\
    --resume --threads \${SLURM_CPUS_PER_TASK:-0} $(quoted "${options[@]}") || status=\$?
  ((status == 0)) && { rm -f \"\$checkpoint\"*.exr; exit 0; }
  ((status == 2)) && break
done
exit \$status"
merge="$common
shopt -s nullglob extglob
setFrame \${SLURM_ARRAY_TASK_ID:-0}
exec $(quoted "$chromeball" merge) \"\$folder\"/part-+([0-9])${frames:+.\$frame}.exr \"\${outputs[@]/#/-o}\""

array=$(sbatch --parsable --job-name=chromeball --array="0-$((count * ${shards:-1} - 1))" --requeue \
  --output="$parts/task-%a.log" "${sbatch[@]}" <<< "$task")
[[ -n $shards ]] || { echo "$array"; exit; }
merging=$(sbatch --parsable --job-name=chromeball-merge --dependency=afterany:"$array" \
  ${frames:+--array=0-$((count - 1))} --output="$parts/merge${frames:+-%a}.log" <<< "$merge")
echo "$array $merging"
