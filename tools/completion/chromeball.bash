# SPDX-License-Identifier: Apache-2.0
# Written by tools/scripts/manual.py; edits are lost.
_chromeball() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  local command='' words='' options=''
  ((COMP_CWORD > 1)) && command=${COMP_WORDS[1]}
  case $command in
    probe|image|camera) ((COMP_CWORD > 2)) && command+=" ${COMP_WORDS[2]}" ;;
  esac
  case $command in
    '')
      words='render merge compare bake basis relight probe image camera lights lights-error info doctor reference'
      options='--help --version' ;;
    'render')
      options='--help --progress --quiet --animation --animation-time --variant --camera --camera-file --fov --view --look-at --zoom --shutter --shutter-steps --probe --probe-mapping --probe-rotation --probe-scale --strategy --mis --sun-angle --light-from --show-lights --lights --light-units --size --quality --samples --time --noise --adaptive --guide --regularize --glass-shadows --denoise --integrator --ao --reflection-occlusion --ao-distance --bent --irradiance-cache --max-depth --max-diffuse-depth --max-specular-depth --max-transmission-depth --ground --drop --single-sided --seed --clamp --transparent --shadow-catcher --two-pass --crop --shard --orbit --turntable --orbit-step --allow-external --output --aov --develop --exposure --tonemap --white-balance --memory --texture-memory --threads --stats --noise-map --frames --frame --fps --overwrite --seed-per-frame --probe-sequence --write-every --preview --display --cache --checkpoint --checkpoint-every --resume' ;;
    'merge')
      options='--help --output --progress --quiet --exposure --tonemap --white-balance' ;;
    'compare')
      options='--help --strategies --integrators --samples --times --repeats --reference --reference-samples --reference-strategy --baseline --output --progress --quiet --animation --animation-time --variant --camera --camera-file --fov --view --look-at --zoom --shutter --shutter-steps --probe --probe-mapping --probe-rotation --probe-scale --mis --sun-angle --light-from --lights --light-units --size --max-depth --max-diffuse-depth --max-specular-depth --max-transmission-depth --ground --drop --single-sided --seed --allow-external --exposure --memory --texture-memory --threads' ;;
    'bake')
      options='--help --white --output --what --to --size --texel --padding --denoise --no-denoise --keep-materials --progress --quiet --animation --animation-time --variant --camera --probe --probe-mapping --probe-rotation --probe-scale --strategy --sun-angle --light-from --light-units --samples --ao-distance --max-depth --seed --allow-external --memory --texture-memory --threads' ;;
    'basis')
      options='--help --at --directions --basis --glossy --clusters --vectors --half --output --progress --quiet --animation --animation-time --variant --camera --camera-file --fov --view --look-at --zoom --mis --light-units --size --samples --glass-shadows --max-depth --max-diffuse-depth --max-specular-depth --max-transmission-depth --single-sided --seed --transparent --allow-external --memory --texture-memory --threads' ;;
    'relight')
      options='--help --images --directions --irradiance --probe --probe-mapping --probe-rotation --probe-scale --domain --keep --keep-light --reflectance-function --output --preview --white --view --allow-external --memory --exposure --tonemap --progress --quiet' ;;
    'probe')
      words='info convert convolve assemble reflectivity synth edit merge sun split add-sun align stitch crop spheres irradiance rays plot'
      options='--help' ;;
    'probe info')
      options='--help --probe-mapping --probe-rotation --json --mapping-report' ;;
    'probe convert')
      options='--help --to --probe-mapping --size --probe-rotation --probe-scale --flip --progress --quiet' ;;
    'probe convolve')
      options='--help --kernel --size --from-size --method --mips --probe-rotation --probe-mapping --progress --quiet' ;;
    'probe assemble')
      options='--help --output --azimuth --circle --mask --distance --reflectivity --ball-ior --schlick --camera-disc --probe-mapping --keep-exposure --keep-azimuth --fill --to --size --preview --json --progress --quiet' ;;
    'probe reflectivity')
      options='--help --direct --reflected --against --standard-reflectance --saturation --json' ;;
    'probe synth')
      options='--help --size --radiance --texel --direction --slope --sun-elevation --sun-azimuth --turbidity --ground-albedo --no-sun --progress --quiet' ;;
    'probe edit')
      options='--help --probe-rotation --fill-nadir --below-horizon --region --gain --probe-scale --clip --clip-stops --probe-mapping --progress --quiet' ;;
    'probe merge')
      options='--help --output --exposures --apertures --aperture-ratio --filter --flat-field --response --write-response --smoothness --white --resize --unaligned --calibrate-filter --json --progress --quiet' ;;
    'probe sun')
      options='--help --diffuse --circle --paint --camera --distance --angle --direction --mask --output --lights --residual --probe-mapping --json --progress --quiet' ;;
    'probe split')
      options='--help --suns --rest --angle --probe-mask --probe-mapping --progress --quiet' ;;
    'probe add-sun')
      options='--help --lights --probe-mapping --progress --quiet' ;;
    'probe align')
      options='--help --output --json --probe-mapping-a --probe-mapping-b --progress --quiet' ;;
    'probe stitch')
      options='--help --output --size --refine --poses --same-exposure --progress --quiet' ;;
    'probe crop')
      options='--help --fov --yaw --pitch --roll --size --probe-mapping --progress --quiet' ;;
    'probe spheres')
      options='--help --json --output --size --probe-mapping-predicted --probe-mapping-true --progress --quiet' ;;
    'probe irradiance')
      options='--help --size --method --probe-rotation --probe-mapping --progress --quiet' ;;
    'probe rays')
      options='--help --error --size --probe-rotation --probe-mapping --json --progress --quiet' ;;
    'probe plot')
      options='--help --row --elevation --azimuth --samples --compensated --probe-mapping --progress --quiet' ;;
    'image')
      words='denoise develop divide error flat-field relight view'
      options='--help' ;;
    'image denoise')
      options='--help --progress --quiet' ;;
    'image develop')
      options='--help --clip --depth-blur --motion --bloom --glare --vignette --fov --exact --progress --quiet --exposure --tonemap --white-balance' ;;
    'image divide')
      options='--help --output --progress --quiet' ;;
    'image error')
      options='--help --json --flip --output --map --progress --quiet' ;;
    'image flat-field')
      options='--help --output --at --radius --centre --json --progress --quiet' ;;
    'image relight')
      options='--help --gain --probe --bent --suns --add --probe-rotation --probe-scale --probe-mapping --output --exposure --tonemap --progress --quiet' ;;
    'image view')
      options='--help --layer --progress --quiet --exposure --tonemap --white-balance' ;;
    'camera')
      words='solve'
      options='--help' ;;
    'camera solve')
      options='--help --points --lines --fspy --output --fov --focal35 --distortion --principal-point --height --origin --up --preview --json --progress --quiet' ;;
    'lights')
      options='--help --method --suggest --polygons --count --output --format --angle --light-units --preview --regions --sphere --normals --recursion --max-error --ambient --seed --probe-rotation --probe-mask --probe-mapping --progress --quiet' ;;
    'lights-error')
      options='--help --methods --counts --recursion --normals --csv --plot --seed --probe-mask --probe-mapping --progress --quiet' ;;
    'info')
      options='--help --json --all --allow-external' ;;
    'doctor')
      options='--help --json' ;;
    'reference')
      options='--help' ;;
  esac
  case "$command $previous" in
  esac
  [[ $current == -* ]] && words=$options
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}
# File names where there is nothing else to offer.
complete -o default -F _chromeball chromeball
