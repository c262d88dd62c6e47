#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Renders a scene on a Slurm cluster: a job array of shards, and a job that merges them.
#
#   tools/scripts/farm_slurm.sh SCENE --shards N -o OUT.exr [-o OUT.png] [--sbatch OPTIONS] [-- RENDER OPTIONS]
#
# The parts go to the folder OUT.parts, which all machines must share with the scene and the program.
# A task that is preempted, killed or requeued goes on from its checkpoint there; one that fails is
# tried three times. The last job merges what there is, or says what is missing: then call this
# again with the same arguments, which renders only that.
#   --sbatch "..."    options for each task: "--cpus-per-task=32 --time=8:00:00 --partition=preempt"
# Prints the ids of the two jobs. $CHROMEBALL names the program (default: this build's).
set -euo pipefail

usage() { sed -n '5,13s/^# \{0,1\}//p' "$0" >&2; exit 2; }
fail() { echo "farm_slurm.sh: $*" >&2; exit 2; }

chromeball=${CHROMEBALL:-$(cd "$(dirname "$0")/../.." && pwd)/build/chromeball}
scene='' shards='' outputs=() sbatch=() options=()
while (($#)); do
  case $1 in
    --shards) shards=${2:?}; shift 2 ;;
    -o|--output) outputs+=("$(realpath -m "${2:?}")"); shift 2 ;;
    --sbatch) read -ra sbatch <<< "${2:?}"; shift 2 ;;
    --) shift; options=("$@"); break ;;
    -*) usage ;;
    *) [[ -z $scene ]] || usage; scene=$(realpath "$1"); shift ;;
  esac
done
[[ -n $scene && ${#outputs[@]} -gt 0 ]] || usage
[[ $shards =~ ^[1-9][0-9]*$ ]] || fail "--shards: give the number of parts"
[[ -x $chromeball ]] || fail "$chromeball: not found; build it, or set CHROMEBALL"
command -v sbatch >/dev/null || fail "sbatch: not found; this needs Slurm"

parts=${outputs[0]%.*}.parts
mkdir -p "$parts"
quoted() { printf '%q ' "$@"; }

# Exit status 2 is an error of the input, which another attempt does not mend.
task="#!/usr/bin/env bash
part=$(quoted "$parts")
part+=/part-\$SLURM_ARRAY_TASK_ID.exr checkpoint=\${part%.exr}.checkpoint
[[ -e \$part ]] && exit 0
for attempt in 1 2 3; do
  status=0
  $(quoted "$chromeball" render "$scene") --shard \$SLURM_ARRAY_TASK_ID/$shards -o \"\$part\" \\
    --checkpoint \"\$checkpoint.exr\" --resume --threads \${SLURM_CPUS_PER_TASK:-0} \\
    $(quoted "${options[@]}") || status=\$?
  ((status == 0)) && { rm -f \"\$checkpoint.exr\"; exit 0; }
  ((status == 2)) && break
done
exit \$status"
results=()
for output in "${outputs[@]}"; do results+=(-o "$output"); done
merge="#!/usr/bin/env bash
shopt -s nullglob extglob
folder=$(quoted "$parts")
exec $(quoted "$chromeball" merge) \"\$folder\"/part-+([0-9]).exr $(quoted "${results[@]}")"

array=$(sbatch --parsable --job-name=chromeball --array=1-"$shards" --requeue \
  --output="$parts/part-%a.log" "${sbatch[@]}" <<< "$task")
merging=$(sbatch --parsable --job-name=chromeball-merge --dependency=afterany:"$array" \
  --output="$parts/merge.log" <<< "$merge")
echo "$array $merging"
