// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "composite/layers.h"
#include "front/quality.h"
#include "front/settings.h"
#include "image/tonemap.h"
#include "render/render.h"

namespace chromeball {
namespace {

std::vector<std::string_view> layers() {
  std::vector<std::string_view> names;
  for (const AovInfo& info : allAovs()) names.push_back(info.name);
  for (const CompositeLayerInfo& info : compositeLayers())
    if (info.layer != CompositeLayer::Alpha) names.push_back(info.name);
  names.insert(names.end(), {kLightGroups, kShadowMattes});
  return names;
}

std::string_view qualityHelp() {
  static const std::string help =
      fmt::format("Stands for other settings, of which given ones win. {}.", qualitiesInWords());
  return help;
}

}  // namespace

std::vector<Setting> renderRows() {
  using enum SettingType;
  const RenderSettings usual;
  std::vector<Setting> rows{
      {.key = "size",
       .argument = "WxH",
       .type = Size,
       .range = {.min = 1, .max = 65536},
       .unit = "pixels",
       .absent = "the plate's; else 600 pixels high, with the aspect ratio of the model's camera",
       .help = "Width and height of the image."},
  };
  addRenderOnly(
      rows, Effect::Limit,
      {
          {.key = "quality",
           .argument = "NAME",
           .type = Choice,
           .absent = "the defaults of the others",
           .choices = qualityNames(),
           .help = qualityHelp()},
          {.key = "samples",
           .type = Integer,
           .range = {.min = 1, .max = kMaxSamples},
           .fallback = std::to_string(usual.samples),
           .help = "Samples per pixel; with a limit on time or noise, their maximum (then "
                   "unlimited by default)."},
          {.key = "time",
           .argument = "SECONDS",
           .type = Number,
           .range = kPositive,
           .unit = "seconds",
           .absent = "no limit",
           .help = "Takes about this time, with denoising and writing but without loading; not "
                   "before each "
                   "pixel has 4 samples."},
          {.key = "noise",
           .argument = "PERCENT",
           .type = Number,
           .range = kPositive,
           .unit = "percent",
           .absent = "no limit",
           .help = "Stops when the upper end of the noise's 95% interval is below this."},
      });
  addRenderOnly(
      rows, Effect::Image,
      {
          {.key = "adaptive",
           .type = Choice,
           .fallback = usual.adaptive ? "on" : "off",
           .choices = {"on", "off"},
           .help = "Takes more samples in noisier pixels, if there are at least 16 per pixel; "
                   "`samples` is then their mean."},
          {.key = "guide",
           .type = Choice,
           .fallback = "auto",
           .choices = {"auto", "on", "off"},
           .help = "Learns from which directions the probe lights each region, for light samples "
                   "(rooms) and for bounces towards caustics, with `importance`: auto where that "
                   "pays, on always; from 8 samples per pixel."},
          {.key = "regularize",
           .type = Flag,
           .help = "Widens glossy reflection and glass that light reaches after a diffuse bounce "
                   "(biased): no fireflies from caustics. The bias falls with the samples."},
          {.key = "glass_shadows",
           .type = Choice,
           .fallback = "refract",
           .choices = {"refract", "straight"},
           .help = "Light that reaches surfaces through smooth bodies of glass is refracted "
                   "(refract), or passes straight, tinted by the glass (straight, biased): no "
                   "caustics, less noise."},
          {.key = "denoise",
           .type = Flag,
           .help = "Removes noise (biased). An .exr also has the noisy image, `noisy`, and the "
                   "estimated standard error of what is left, `denoise_error`."},
          {.key = "integrator",
           .type = Choice,
           .fallback = std::string(kIntegratorNames[size_t(usual.integrator)]),
           .choices = {kIntegratorNames.begin(), kIntegratorNames.end()},
           .help = "path: all light. Approximations: direct, paths of one bounce; environment-map, "
                   "the probe prefiltered by normal and mirror direction, without shadows and "
                   "interreflection (rough metal is off by 5% to 55% under most real probes); "
                   "ambient-occlusion, the same with `ao` and `reflection_occlusion`. With the "
                   "strategy suns these cast the shadows of suns."},
          {.key = "ao",
           .type = Flag,
           .help = "With environment-map: ambient occlusion darkens diffuse light."},
          {.key = "reflection_occlusion",
           .type = Flag,
           .help = "With environment-map: geometry blocks the probe's reflections."},
          {.key = "ao_distance",
           .argument = "M",
           .type = Number,
           .range = kPositive,
           .unit = "metres",
           .absent = "any distance",
           .help = "Surfaces farther away do not count in ambient occlusion and bent normals."},
          {.key = "bent",
           .type = Choice,
           .fallback = "cosine",
           .choices = {"cosine", "uniform"},
           .help = "The layer bent_normal is the mean of the visible directions, weighted by the "
                   "cosine or not."},
          {.key = "irradiance_cache",
           .argument = "ERROR",
           .type = Number,
           .range = {.min = 0, .max = 1, .excludesMin = true},
           .absent = "all light is path traced",
           .help = "Interpolates the light that diffuse surfaces in view receive from other "
                   "surfaces (biased): 0.2 is usual, smaller is slower and more accurate."},
      });
  rows.insert(rows.end(),
              {
                  {.key = "max_depth",
                   .type = Integer,
                   .range = {.min = 0, .max = kMaxDepth},
                   .fallback = std::to_string(usual.maxDepth),
                   .help = "Maximum number of bounces: 0 emission only, 1 direct light, ..."},
                  {.key = "max_diffuse_depth",
                   .type = Integer,
                   .range = {.min = 0, .max = kMaxDepth},
                   .absent = "max_depth",
                   .help = "Maximum number of bounces whose direction a diffuse lobe chose."},
                  {.key = "max_specular_depth",
                   .type = Integer,
                   .range = {.min = 0, .max = kMaxDepth},
                   .absent = "max_depth",
                   .help = "Maximum number of bounces whose direction a specular lobe chose."},
                  {.key = "max_transmission_depth",
                   .type = Integer,
                   .range = {.min = 0, .max = kMaxDepth},
                   .fallback = std::to_string(usual.maxTransmissionDepth),
                   .help = "Maximum number of bounces in and on bodies of glass, which are not "
                           "counted as other bounces."},
                  {.key = "ground",
                   .argument = "HEIGHT",
                   .bare = "auto",
                   .type = NumberOrAuto,
                   .unit = "metres",
                   .absent = "none",
                   .help = "Puts a matte grey plane under the model: at its lowest point, at all "
                           "times of an animation, or at this height (y). The `ground` of a shadow "
                           "catcher has the same height."},
                  {.key = "drop",
                   .type = Flag,
                   .help = "Moves the model up or down so that its lowest point, at all times of "
                           "an animation, is at the height of the ground, or else at 0."},
                  {.key = "single_sided",
                   .type = Choice,
                   .absent = "camera; light for a view inside a closed room, or of a body turned "
                             "inside out, that would be black without",
                   .choices = {"camera", "light", "off"},
                   .help = "Backs of single-sided surfaces are invisible to the camera and mirrors "
                           "(camera), pass all light (light), or are like fronts (off)."},
                  {.key = "seed",
                   .type = Integer,
                   .range = {.min = 0},
                   .fallback = "0",
                   .help = "Another seed gives another independent image."},
              });
  return rows;
}

std::vector<Setting> outputRows() {
  using enum SettingType;
  return {
      {.key = "file",
       .option = "output",
       .letter = 'o',
       .argument = "FILE",
       .type = Files,
       .absent = "required for `render`",
       .help = "Image to write: .exr, .hdr, .pfm or .png; may be given repeatedly.",
       .effect = Effect::Run,
       .renderOnly = true},
      {.key = "aovs",
       .option = "aov",
       .argument = "NAME,...",
       .type = Choices,
       .absent = "none",
       .choices = layers(),
       .help = "Layers of the .exr beside the colour. l_obj, l_noobj, difference and reflectance "
               "are those of a composite. light_groups are layers light.NAME, the radiance from "
               "each source; shadow_mattes are shadow.NAME, the factor by which its shadow "
               "darkens. ao and bent_normal serve `image relight`.",
       .renderOnly = true},
      {.key = "develop",
       .argument = "\"NAME=VALUE ...\"",
       .type = Name,
       .absent = "as rendered",
       .help = "Optics of a .png, before tone mapping, as the options of `image develop`: "
               "\"bloom=.75:1,.15:8,.07:32,.03:128 vignette=.4\"; also clip, depth-blur, motion, "
               "glare. An .exr stays as rendered.",
       .effect = Effect::Display,
       .renderOnly = true},
      {.key = "exposure",
       .argument = "STOPS",
       .type = NumberOrAuto,
       .range = {.min = -100, .max = 100},
       .unit = "stops",
       .fallback = "auto",
       .help =
           "Exposure of a .png: radiance times 2^STOPS. auto: chosen from the surfaces in view, "
           "and printed; for a sequence, from its first frame. A composite with a plate has 0, and "
           "no "
           "auto.",
       .effect = Effect::Display},
      {.key = "tonemap",
       .argument = "NAME",
       .type = Choice,
       .fallback = "none",
       .choices = toneOperatorNames(),
       .help = "Tone operator of a .png.",
       .effect = Effect::Display,
       .renderOnly = true},
      {.key = "white_balance",
       .argument = "KELVIN",
       .type = Numbers,
       .form = "a number, or three",
       .counts = {1, 3},
       .range = kNotNegative,
       .unit = "kelvin",
       .absent = "6504",
       .help = "The light that is white in a .png: the temperature of a black body, 2000 to 25000, "
               "or a colour, all above 0. A lower temperature makes the picture bluer.",
       .effect = Effect::Display,
       .renderOnly = true},
  };
}

}  // namespace chromeball
