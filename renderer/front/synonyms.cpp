// SPDX-License-Identifier: Apache-2.0
#include "front/synonyms.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

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
     "aa-samples sample iterations "},
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
     "environment-intensity brightness scale probe-intensity probe-strength probe-brightness "},
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
    {"aov", " layers channels cryptomatte denoising-data passes passes-out render-passes "},
    {"clamp", " clamp-direct clamp-indirect firefly-clamp max-radiance maxcomponentvalue "},
    {"seed", " rng-seed random-seed "},
    {"camera", " cam viewpoint "},
    {"fov", " focal-length focal lens sensor sensor-width field-of-view camera-fov "},
    {"glass-shadows", " caustics "},
    {"animation-time", " frame f at-time "},
    {"stats", " statistics log report "},
    {"integrator", " engine render-engine "},
    {"ground", " floor ground-plane groundplane floor-plane "},
    {"shadow-catcher", " shadow shadows shadowcatcher catch-shadows "},
};

constexpr Synonyms kOptions[] = {
    {"progress", " verbose v "},
    {"quiet", " silent q "},
    {"samples", " quality preset quality-preset "},
};

constexpr Synonyms kPlaces[] = {
    {"materials are those of the model (glTF)", " material materials shader shaders bsdf texture "},
    {"models are [[model]] in a scene file", " object objects mesh meshes geometry shape shapes "},
    {"a lens is `aperture` and `focus` in [camera]",
     " aperture fstop f-stop f-number dof depth-of-field focus focus-distance bokeh blades "},
    {"a camera is [camera] in a scene file: `position` and `look_at`; --view has angles",
     " target lookat origin camera-position "},
    {"--view has names, too: --view front",
     " front back left right above below top bottom side iso isometric "},
    {"renders run on the processor", " gpu device cuda metal backend gpus "},
    {"lamps are [[light]] in a scene file, or those of the model; an environment is a probe: "
     "--probe, [probe]",
     " light lamp lamps emitter emitters sun sunlight point-light area-light "},
    {"the ending of an image's name decides its format: --output FILE.exr, `file` in [output]",
     " format file-format image-format output-format "},
    {"surfaces are rendered, not their edges", " wireframe wireframes wire edges "},
};

struct KeySynonyms {
  std::string_view section;  // or, of values, the name of the setting
  Synonyms known;
};

constexpr KeySynonyms kListKeys[] = {
    {"model", {"translation", " position location translate offset origin "}},
    {"model", {"rotation", " rotate orientation quaternion "}},
    {"model", {"file", " path filename uri source mesh "}},
    {"light",
     {"colour and strength are one key, of a number or three: `intensity` or `power`; of a disc "
      "`radiance` or `power`, of a sun `radiance` or `irradiance`",
      " color colour strength energy brightness emission flux watts lumens "}},
    {"light", {"position", " location translation origin "}},
    {"light", {"outer_angle", " spot-size spot-angle cone-angle cutoff cutoff-angle "}},
    {"light", {"inner_angle", " spot-blend beam-width "}},
};

constexpr KeySynonyms kValues[] = {
    {"light.type", {"sun", " directional distant sunlight parallel infinite "}},
    {"light.type", {"disc", " area arealight area-light quad rect rectangle square "}},
    {"light.type", {"point", " omni pointlight point-light bulb "}},
    {"light.type", {"spot", " spotlight spot-light "}},
    {"light.type",
     {"an environment is a probe: `file` in [probe]",
      " ambient dome domelight environment env hdri sky skydome "}},
    {"lighting.strategy",
     {"multiple importance sampling is a setting of its own; see --mis and `mis` in [lighting]",
      " mis multiple-importance-sampling "}},
    {"render.quality", {"final", " high highest best production ultra "}},
    {"render.quality", {"good", " medium normal default "}},
    {"render.quality", {"draft", " preview low lowest fast "}},
    {"render.integrator", {"path", " pathtracer path-tracer pathtracing path-tracing cycles "}},
};

// In lower case, with dashes inside and between spaces, as the tables have words.
std::string asInTable(std::string_view word) {
  std::string name = lowerCase(word.substr(std::min(word.find_first_not_of('-'), word.size())));
  std::ranges::replace(name, '_', '-');
  return ' ' + name + ' ';
}

std::string_view oursIn(std::span<const Synonyms> table, std::string_view word) {
  const std::string name = asInTable(word);
  for (const Synonyms& s : table)
    if (s.words.find(name) != s.words.npos) return s.ours;
  return {};
}

std::string_view oursIn(std::span<const KeySynonyms> table, std::string_view section,
                        std::string_view word) {
  const std::string name = asInTable(word);
  for (const auto& [of, known] : table)
    if (of == section && known.words.find(name) != known.words.npos) return known.ours;
  return {};
}

// A name is suggested; a sentence says what to do itself.
std::string hintFrom(std::string_view ours, const std::vector<std::string_view>& names) {
  return std::ranges::count(names, ours) > 0 ? fmt::format("did you mean `{}`?", ours)
                                             : std::string(ours);
}

}  // namespace

const Setting* settingCalled(std::string_view word) {
  const std::string_view option = oursIn(kSettings, word);
  if (option.empty()) return nullptr;
  return &*std::ranges::find(settingTable(), option, &Setting::option);
}

std::string_view optionCalled(std::string_view word) { return oursIn(kOptions, word); }

std::string hintOnListKey(std::string_view section, std::string_view word) {
  return hintFrom(oursIn(kListKeys, section, word), keysOf(section));
}

std::string hintOnValue(const Setting& setting, std::string_view word) {
  return hintFrom(oursIn(kValues, setting.name(), word), setting.choices);
}

std::string_view placeOf(std::string_view word) { return oursIn(kPlaces, word); }

}  // namespace chromeball
