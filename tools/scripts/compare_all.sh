#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the comparisons of docs/measured/results.md: every strategy, two scenes, four probes. The first
# argument is the folder for the reports (default out/compare); other arguments go to
# `chromeball compare`. Galileo's Tomb and Grace Cathedral are read from probes/debevec in
# $CHROMEBALL_DATA (default ../shared/data), and skipped if absent. A run that was stopped continues.
set -euo pipefail
cd "$(dirname "$0")/../.."

folder=${1:-out/compare}
shift || true
data=${CHROMEBALL_DATA:-../shared/data}/probes/debevec
mkdir -p "$folder"
[[ -e $folder/sun.exr ]] || build/chromeball probe synth sun-sky "$folder/sun.exr" --size 1024x512
[[ -e $folder/overcast.exr ]] || build/chromeball probe synth overcast "$folder/overcast.exr" --size 1024x512

compare() {  # MODEL PROBE options
  local name
  name=$(basename "${1%.*}")-$(basename "${2%.*}" _probe)
  echo "$name"
  build/chromeball compare "scenes/models/$1" --probe "$2" --camera Front --strategies all \
    --baseline uniform --samples 1,4,16 --output "$folder/$name" "${@:3}"
}

for probe in "$folder/sun.exr" "$folder/overcast.exr" "$data/galileo_probe.hdr" "$data/grace_probe.hdr"; do
  [[ -e $probe ]] || { echo "skipped: no $probe" >&2; continue; }
  compare pillars.gltf "$probe" --size 96x64 --repeats 4 --reference-samples 1024 "$@"
  compare still-life.glb "$probe" --max-depth 1 --size 72x48 --repeats 3 --reference-samples 768 "$@"
done
