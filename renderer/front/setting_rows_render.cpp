// SPDX-License-Identifier: Apache-2.0
#include "composite/layers.h"
#include "front/settings.h"
#include "render/render.h"

namespace chromeball {
namespace {

using Names = std::vector<std::string_view>;
using enum SettingType;

Names layers() {
  Names names;
  for (const AovInfo& info : allAovs()) names.push_back(info.name);
  for (const CompositeLayerInfo& info : compositeLayers())
    if (info.layer != CompositeLayer::Alpha) names.push_back(info.name);
  names.insert(names.end(), {"light_groups", "shadow_mattes"});
  return names;
}

void addRender(std::vector<Setting>& rows) {
  const RenderSettings usual;
  const auto add = [&](Setting row) {
    row.section = "render";
    rows.push_back(std::move(row));
  };
  add({.key = "size",
       .option = "size",
       .argument = "WxH",
       .type = Size,
       .range = {.min = 1, .max = 65536},
       .unit = "pixels",
       .absent = "the plate's; else 600 pixels high, with the aspect ratio of the model's camera",
       .help = "Width and height of the image."});
  add({.key = "samples",
       .option = "samples",
       .argument = "N",
       .type = Integer,
       .range = {.min = 1, .max = kMaxSamples},
       .fallback = std::to_string(usual.samples),
       .help = "Samples per pixel; with a limit on time or noise, their maximum (then unlimited by "
               "default).",
       .effect = Effect::Limit,
       .renderOnly = true});
  add({.key = "time",
       .option = "time",
       .argument = "SECONDS",
       .type = Number,
       .range = kPositive,
       .unit = "seconds",
       .absent = "no limit",
       .help = "Stops after about this time, but not before each pixel has 4 samples.",
       .effect = Effect::Limit,
       .renderOnly = true});
  add({.key = "noise",
       .option = "noise",
       .argument = "PERCENT",
       .type = Number,
       .range = kPositive,
       .unit = "percent",
       .absent = "no limit",
       .help = "Stops when the upper end of the noise's 95% interval is below this.",
       .effect = Effect::Limit,
       .renderOnly = true});
  add({.key = "adaptive",
       .option = "adaptive",
       .argument = "NAME",
       .type = Choice,
       .fallback = usual.adaptive ? "on" : "off",
       .choices =
           [] {
             return Names{"on", "off"};
           },
       .help = "Takes more samples in noisier pixels, if there are at least 16 per pixel; "
               "`samples` is then their mean.",
       .renderOnly = true});
  add({.key = "guide",
       .option = "guide",
       .argument = "NAME",
       .type = Choice,
       .fallback = "auto",
       .choices =
           [] {
             return Names{"auto", "on", "off"};
           },
       .help = "Learns from which directions the probe lights each region, for light samples "
               "(rooms) and for bounces towards caustics, with `importance`: auto where that "
               "pays, on always; from 8 samples per pixel.",
       .renderOnly = true});
  add({.key = "regularize",
       .option = "regularize",
       .type = Flag,
       .help = "Widens glossy reflection and glass that light reaches after a diffuse bounce "
               "(biased): no fireflies from caustics. The bias falls with the samples.",
       .renderOnly = true});
  add({.key = "glass_shadows",
       .option = "glass-shadows",
       .argument = "NAME",
       .type = Choice,
       .fallback = "refract",
       .choices =
           [] {
             return Names{"refract", "straight"};
           },
       .help = "Light that reaches surfaces through smooth bodies of glass is refracted (refract), "
               "or passes straight, tinted by the glass (straight, biased): no caustics, less "
               "noise.",
       .renderOnly = true});
  add({.key = "denoise",
       .option = "denoise",
       .type = Flag,
       .help =
           "Removes noise (biased). An .exr also has the noisy image, `noisy`, and the estimated "
           "standard error of what is left, `denoise_error`.",
       .renderOnly = true});
  add({.key = "integrator",
       .option = "integrator",
       .argument = "NAME",
       .type = Choice,
       .fallback = std::string(kIntegratorNames[size_t(usual.integrator)]),
       .choices = [] { return Names(kIntegratorNames.begin(), kIntegratorNames.end()); },
       .help = "path: all light. Approximations: direct, paths of one bounce; environment-map, the "
               "probe prefiltered by normal and mirror direction, without shadows and "
               "interreflection (rough metal is off by 5% to 55% under most real probes); "
               "ambient-occlusion, the same with `ao` and "
               "`reflection_occlusion`. With the strategy suns these cast the shadows of suns.",
       .renderOnly = true});
  add({.key = "ao",
       .option = "ao",
       .type = Flag,
       .help = "With environment-map: ambient occlusion darkens diffuse light.",
       .renderOnly = true});
  add({.key = "reflection_occlusion",
       .option = "reflection-occlusion",
       .type = Flag,
       .help = "With environment-map: geometry blocks the probe's reflections.",
       .renderOnly = true});
  add({.key = "ao_distance",
       .option = "ao-distance",
       .argument = "M",
       .type = Number,
       .range = kPositive,
       .unit = "metres",
       .absent = "any distance",
       .help = "Surfaces farther away do not count in ambient occlusion and bent normals.",
       .renderOnly = true});
  add({.key = "bent",
       .option = "bent",
       .argument = "NAME",
       .type = Choice,
       .fallback = "cosine",
       .choices =
           [] {
             return Names{"cosine", "uniform"};
           },
       .help = "The layer bent_normal is the mean of the visible directions, weighted by the "
               "cosine or not.",
       .renderOnly = true});
  add({.key = "irradiance_cache",
       .option = "irradiance-cache",
       .argument = "ERROR",
       .type = Number,
       .range = {.min = 0, .max = 1, .excludesMin = true},
       .absent = "all light is path traced",
       .help = "Interpolates the light that diffuse surfaces in view receive from other surfaces "
               "(biased): 0.2 is usual, smaller is slower and more accurate.",
       .renderOnly = true});
  add({.key = "max_depth",
       .option = "max-depth",
       .argument = "N",
       .type = Integer,
       .range = {.min = 0, .max = kMaxDepth},
       .fallback = std::to_string(usual.maxDepth),
       .help = "Maximum number of bounces: 0 emission only, 1 direct light, ..."});
  add({.key = "max_diffuse_depth",
       .option = "max-diffuse-depth",
       .argument = "N",
       .type = Integer,
       .range = {.min = 0, .max = kMaxDepth},
       .absent = "max_depth",
       .help = "Maximum number of bounces whose direction a diffuse lobe chose."});
  add({.key = "max_specular_depth",
       .option = "max-specular-depth",
       .argument = "N",
       .type = Integer,
       .range = {.min = 0, .max = kMaxDepth},
       .absent = "max_depth",
       .help = "Maximum number of bounces whose direction a specular lobe chose."});
  add({.key = "max_transmission_depth",
       .option = "max-transmission-depth",
       .argument = "N",
       .type = Integer,
       .range = {.min = 0, .max = kMaxDepth},
       .fallback = std::to_string(usual.maxTransmissionDepth),
       .help = "Maximum number of bounces in and on bodies of glass, which are not counted as "
               "other bounces."});
  add({.key = "single_sided",
       .option = "single-sided",
       .argument = "NAME",
       .type = Choice,
       .fallback = "camera",
       .choices =
           [] {
             return Names{"camera", "light", "off"};
           },
       .help = "Backs of single-sided surfaces are invisible to the camera and mirrors (camera), "
               "pass all light (light), or are like fronts (off)."});
  add({.key = "seed",
       .option = "seed",
       .argument = "N",
       .type = Integer,
       .range = {.min = 0},
       .fallback = "0",
       .help = "Another seed gives another independent image."});
}

void addOutput(std::vector<Setting>& rows) {
  rows.push_back({.section = "output",
                  .key = "file",
                  .option = "output",
                  .letter = 'o',
                  .argument = "FILE",
                  .type = Files,
                  .absent = "required for `render`",
                  .help = "Image to write: .exr, .hdr, .pfm or .png; may be given repeatedly.",
                  .effect = Effect::Run,
                  .renderOnly = true});
  rows.push_back({.section = "output",
                  .key = "aovs",
                  .option = "aov",
                  .argument = "NAME,...",
                  .type = Choices,
                  .absent = "none",
                  .choices = layers,
                  .help = "Layers of the .exr beside the colour. l_obj, l_noobj, difference and "
                          "reflectance are those of a composite. light_groups are layers "
                          "light.NAME, the radiance from each source; shadow_mattes are "
                          "shadow.NAME, the factor by which its shadow darkens. ao and "
                          "bent_normal serve `image relight`.",
                  .renderOnly = true});
  rows.push_back({.section = "output",
                  .key = "develop",
                  .option = "develop",
                  .argument = "\"NAME=VALUE ...\"",
                  .type = Name,
                  .absent = "as rendered",
                  .help = "Optics of a .png, before tone mapping, as the options of `image "
                          "develop`: \"bloom=.75:1,.15:8,.07:32,.03:128 vignette=.4\"; also clip, "
                          "depth-blur, motion, glare. An .exr stays as rendered.",
                  .effect = Effect::Display,
                  .renderOnly = true});
}

}  // namespace

std::vector<Setting> renderRows() {
  std::vector<Setting> rows;
  addRender(rows);
  addOutput(rows);
  return rows;
}

}  // namespace chromeball
