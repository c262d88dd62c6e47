#!/usr/bin/env bash
# The comparisons of tools/RESULTS.md: every strategy, on two scenes under four probes. The first
# argument is the folder for the reports (out/compare); other arguments go to `chromeball compare`.
# Galileo's Tomb and Grace Cathedral are looked for in $CHROMEBALL_DATA/probes/debevec, or
# ../shared/data there, and left out where they are absent. A run that was stopped is continued.
set -euo pipefail
cd "$(dirname "$0")/.."

folder=${1:-out/compare}
shift || true
data=${CHROMEBALL_DATA:-../shared/data}/probes/debevec
mkdir -p "$folder"
[[ -e $folder/sun.exr ]] || build/chromeball probe synth sun-sky "$folder/sun.exr" --size 1024x512
[[ -e $folder/overcast.exr ]] || build/chromeball probe synth overcast "$folder/overcast.exr" --size 1024x512

for probe in "$folder/sun.exr" "$folder/overcast.exr" "$data/galileo_probe.hdr" "$data/grace_probe.hdr"; do
  [[ -e $probe ]] || { echo "no $probe" >&2; continue; }
  for model in scenes/models/pillars.gltf scenes/models/still-life.glb; do
    name=$(basename "${model%.*}")-$(basename "${probe%.*}" _probe)
    echo "$name"
    build/chromeball compare "$model" --probe "$probe" --camera Front --size 96x64 \
      --strategies all --baseline uniform --samples 1,4,16 --repeats 4 --reference-samples 1024 \
      --output "$folder/$name" "$@"
  done
done
