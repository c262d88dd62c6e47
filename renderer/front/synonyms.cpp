// SPDX-License-Identifier: Apache-2.0
#include "front/synonyms.h"

#include <algorithm>
#include <span>
#include <string>

#include "base/text.h"
#include "front/settings.h"

namespace chromeball {
namespace {

struct Synonyms {
  std::string_view ours;   // an option without dashes, or a sentence
  std::string_view words;  // each between spaces
};

// Of Blender, Cycles, Mitsuba, pbrt, LuxCore, Arnold, appleseed and image tools.
constexpr Synonyms kSettings[] = {
    {"samples",
     " spp s sample-count num-samples nsamples samples-per-pixel pixel-samples pixelsamples "
     "aa-samples sample iterations passes "},
    {"output", " outfile output-file out render-output save filename file image dest "},
    {"size",
     " width height w resolution res dimensions image-size x y resolution-x resolution-y "
     "film-size "},
    {"probe",
     " envmap env env-map envlight environment environment-map hdri hdr ibl sky skydome background "
     "world infinite-light environment-image "},
    {"probe-rotation",
     " rotation rotate env-rotation envmap-rotation hdri-rotation environment-rotation yaw "},
    {"probe-scale",
     " env-strength env-intensity envmap-scale hdri-strength intensity strength "
     "environment-intensity brightness scale "},
    {"max-depth",
     " bounces max-bounces depth maxdepth path-depth max-path-length path-length ray-depth "
     "recursion "},
    {"time", " time-limit max-time timeout seconds halttime "},
    {"noise", " noise-threshold adaptive-threshold noise-level error noise-limit "},
    {"threads", " t j jobs nthreads num-threads cores cpus "},
    {"strategy", " light-sampler lightsampler sampler sampling lightstrategy "},
    {"tonemap",
     " tone-mapping tonemapping tonemapper view-transform look aces agx filmic ocio gamma "},
    {"exposure", " ev stops film-exposure "},
    {"white-balance", " wb kelvin temperature whitepoint white-point "},
    {"quality", " preset quality-preset preview-quality draft "},
    {"denoise", " denoiser denoising oidn optix "},
    {"transparent", " alpha film-transparent no-background transparent-background "},
    {"aov", " layers channels cryptomatte denoising-data passes-out render-passes "},
    {"clamp", " clamp-direct clamp-indirect firefly-clamp max-radiance maxcomponentvalue "},
    {"seed", " rng-seed random-seed "},
    {"camera", " cam viewpoint "},
    {"fov", " focal-length focal lens sensor sensor-width field-of-view camera-fov "},
    {"glass-shadows", " caustics "},
    {"animation-time", " frame f at-time "},
    {"stats", " statistics log report "},
    {"progress", " verbose v "},
    {"quiet", " silent q "},
};

constexpr Synonyms kPlaces[] = {
    {"materials are those of the model (glTF)", " material materials shader shaders bsdf texture "},
    {"models are [[model]] in a scene file", " object objects mesh meshes geometry shape shapes "},
    {"a lens is `aperture` and `focus` in [camera]",
     " fstop f-stop f-number dof depth-of-field focus focus-distance bokeh blades "},
    {"a camera is [camera] in a scene file: `position` and `look_at`; --view has angles",
     " target lookat origin camera-position "},
    {"renders run on the processor", " gpu device cuda metal backend gpus "},
    {"lamps are [[light]] in a scene file, or those of the model; an environment is a probe: "
     "--probe, [probe]",
     " light lamp lamps emitter emitters sun sunlight point-light area-light "},
};

std::string_view oursIn(std::span<const Synonyms> table, std::string_view word) {
  std::string name = lowerCase(word.substr(std::min(word.find_first_not_of('-'), word.size())));
  std::ranges::replace(name, '_', '-');
  const auto has = [&](const Synonyms& s) {
    return s.words.find(' ' + name + ' ') != s.words.npos;
  };
  const auto found = std::ranges::find_if(table, has);
  return found == table.end() ? std::string_view() : found->ours;
}

}  // namespace

const Setting* settingCalled(std::string_view word) {
  const std::string_view option = oursIn(kSettings, word);
  if (option.empty()) return nullptr;
  return &*std::ranges::find(settingTable(), option, &Setting::option);
}

std::string_view placeOf(std::string_view word) { return oursIn(kPlaces, word); }

}  // namespace chromeball
