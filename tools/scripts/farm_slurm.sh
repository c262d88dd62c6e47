#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Renders a scene on a Slurm cluster: a job array of shards, and a job that merges them; or a job
# array of frames.
#
#   tools/scripts/farm_slurm.sh SCENE --shards N -o OUT.exr [-o OUT.png] [--sbatch OPTIONS] [-- RENDER OPTIONS]
#   tools/scripts/farm_slurm.sh SCENE --frames A:B[:STEP] -o frame.####.exr ...
#
# The parts go to the folder OUT.parts, which all machines must share with the scene and the program.
# A task that is preempted, killed or requeued goes on from its checkpoint there; one that fails is
# tried three times. The last job merges what there is, or says what is missing: then call this
# again with the same arguments, which renders only that. Of frames, the folder has only checkpoints
# and logs.
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
[[ -z $shards || -z $frames ]] || fail "give --shards or --frames"
if [[ -n $frames ]]; then
  [[ $frames =~ ^([0-9]+):([0-9]+)(:([1-9][0-9]*))?$ ]] || fail "--frames: give FIRST:LAST[:STEP]"
  first=$((10#${BASH_REMATCH[1]})) last=$((10#${BASH_REMATCH[2]})) step=${BASH_REMATCH[4]:-1}
  ((first <= last)) || fail "--frames: give FIRST:LAST[:STEP]"
  tasks=0-$(((last - first) / step))
else
  [[ $shards =~ ^[1-9][0-9]*$ ]] || fail "--shards: give the number of parts"
  tasks=1-$shards
fi
[[ -x $chromeball ]] || fail "$chromeball: not found; build it, or set CHROMEBALL"
command -v sbatch >/dev/null || fail "sbatch: not found; this needs Slurm"

parts=${outputs[0]%.*} parts=${parts//#/} parts=${parts%.}.parts
mkdir -p "$parts"
quoted() { printf '%q ' "$@"; }

results=()
for output in "${outputs[@]}"; do results+=(-o "$output"); done
if [[ -n $frames ]]; then
  choice="what=(--frames $frames --frame \$(($first + SLURM_ARRAY_TASK_ID * $step)) $(quoted "${results[@]}"))
number=.#"
else
  choice="part=\$folder/part-\$SLURM_ARRAY_TASK_ID.exr number=
[[ -e \$part ]] && exit 0
what=(--shard \$SLURM_ARRAY_TASK_ID/$shards -o \"\$part\")"
fi
# Exit status 2 is an error of the input, which another attempt does not mend.
task="#!/usr/bin/env bash
folder=$(quoted "$parts")
checkpoint=\$folder/part-\$SLURM_ARRAY_TASK_ID.checkpoint
$choice
for attempt in 1 2 3; do
  status=0
  $(quoted "$chromeball" render "$scene") \"\${what[@]}\" --checkpoint \"\$checkpoint\$number.exr\" \\
    --resume --threads \${SLURM_CPUS_PER_TASK:-0} $(quoted "${options[@]}") || status=\$?
  ((status == 0)) && { rm -f \"\$checkpoint\"*.exr; exit 0; }
  ((status == 2)) && break
done
exit \$status"
merge="#!/usr/bin/env bash
shopt -s nullglob extglob
folder=$(quoted "$parts")
exec $(quoted "$chromeball" merge) \"\$folder\"/part-+([0-9]).exr $(quoted "${results[@]}")"

array=$(sbatch --parsable --job-name=chromeball --array="$tasks" --requeue \
  --output="$parts/part-%a.log" "${sbatch[@]}" <<< "$task")
[[ -z $frames ]] || { echo "$array"; exit; }
merging=$(sbatch --parsable --job-name=chromeball-merge --dependency=afterany:"$array" \
  --output="$parts/merge.log" <<< "$merge")
echo "$array $merging"
