#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Measures the table "Cheaper answers" of docs/measured/results.md: three scenes of make_demo (open, interior,
# metals), three probes, and the ways of rendering that leave something out. The first argument is the
# folder for the reports (default out/approximations); other arguments go to `chromeball compare`.
# Grace Cathedral is read from probes/debevec in $CHROMEBALL_DATA (default ../shared/data), and skipped
# if absent. A run that was stopped continues.
set -euo pipefail
cd "$(dirname "$0")/../.."

folder=${1:-out/approximations}
shift || true
grace=${CHROMEBALL_DATA:-../shared/data}/probes/debevec/grace_probe.hdr
tools/build.sh --target chromeball
tools/build.sh --target make_demo
mkdir -p "$folder"
for model in lambertian room conductors; do
  [[ -e $folder/$model.glb ]] || build/make_demo "$model" "$folder/$model.glb"
done
[[ -e $folder/sun.exr ]] || build/chromeball probe synth sun-sky "$folder/sun.exr" --size 1024x512
[[ -e $folder/overcast.exr ]] || build/chromeball probe synth overcast "$folder/overcast.exr" --size 1024x512

modes=("" +denoise +irradiance-cache:0.2 +irradiance-cache:0.4 +diffuse-depth:6+specular-depth:2 +direct
  +environment-map +environment-map+ao +ambient-occlusion)
for model in lambertian room conductors; do
  for probe in "$folder/overcast.exr" "$grace" "$folder/sun.exr"; do
    [[ -e $probe ]] || { echo "skipped: no $probe" >&2; continue; }
    strategy=importance
    [[ $probe == */sun.exr ]] && strategy=suns
    name=$model-$(basename "${probe%.*}" _probe)
    echo "$name"
    [[ -e $folder/$name-reference.exr ]] ||
      build/chromeball render "$folder/$model.glb" --probe "$probe" --strategy "$strategy" --size 160x120 \
        --samples 4096 --seed 1 --guide off --aov variance -o "$folder/$name-reference.exr"
    build/chromeball compare "$folder/$model.glb" --probe "$probe" --size 160x120 \
      --strategies "$(IFS=,; echo "${modes[*]/#/$strategy}")" --baseline "$strategy" --samples 64 \
      --repeats 3 --reference "$folder/$name-reference.exr" --output "$folder/$name" "$@"
  done
done

# The cache, guides and denoising in equal time.
name=room-overcast
for seconds in 4 16; do
  build/chromeball compare "$folder/room.glb" --probe "$folder/overcast.exr" --size 160x120 --times $seconds --repeats 3 \
    --strategies importance,importance+guide,importance+guide+denoise,importance+irradiance-cache:0.3+guide,importance+irradiance-cache:0.3+guide+denoise \
    --baseline importance --reference "$folder/$name-reference.exr" --output "$folder/equal-time-$seconds" "$@"
done
python3 tools/scripts/approximations_table.py "$folder"
