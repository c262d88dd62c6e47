// SPDX-License-Identifier: Apache-2.0
// chromeball relight STAGE.exr --probe P -o OUT.exr: a light stage under a probe.
// chromeball relight STAGE.exr --probe P --probe Q --preview: on a page, where the probes turn.
// chromeball relight MODEL_PRT.glb --probe P -o MODEL_LIT.glb: vertices by their transfer.
#include "relight.h"

#include "base/error.h"
#include "commands.h"
#include "front/arguments.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "probe_options.h"

namespace chromeball {
namespace {

// Options that are given, or differ from their default.
using GivenOptions = std::vector<std::pair<bool, const char*>>;

void refuseGiven(const GivenOptions& options, const char* why) {
  for (const auto& [given, option] : options)
    if (given) throwInput("{}: {}", option, why);
}

GivenOptions optionsOfSum(const RelightOptions& a) {
  return {{a.domain != "auto", "--domain"},
          {a.keep != "100%", "--keep"},
          {a.keepLight != "100%", "--keep-light"},
          {a.rotation != Rotation(), "--probe-rotation"}};
}

GivenOptions optionsOfDisplay(const RelightOptions& a) {
  return {{a.exposure != 0, "--exposure"}, {a.tone != "none", "--tonemap"}};
}

void checkOutput(const RelightOptions& a) {
  if (lowerExtension(a.out) != ".png")
    refuseGiven(optionsOfDisplay(a), "is for a .png; other images are linear");
  if (!a.pixel.empty()) {
    constexpr const char* kWhy = "has no effect with --reflectance-function; leave it out";
    refuseGiven(optionsOfSum(a), kWhy);
    refuseGiven({{a.scale != "1", "--probe-scale"}, {a.mapping != "auto", "--probe-mapping"}},
                kWhy);
  }
  if (a.probes.size() > 1) throwInput("--probe: give one; --preview takes several");
  if (a.out.empty()) throwInput("--output: needs a name; or give --preview");
  checkWritable(a.out);
  std::vector<std::string> inputs{a.stage, a.directions};
  inputs.insert(inputs.end(), a.probes.begin(), a.probes.end());
  checkDistinct({a.out}, inputs);
}

void checkPreview(const RelightOptions& a) {
  constexpr const char* kWhy = "has no effect with --preview; leave it out";
  refuseGiven({{!a.out.empty(), "--output"}, {!a.pixel.empty(), "--reflectance-function"}}, kWhy);
  refuseGiven(optionsOfSum(a), kWhy);
  refuseGiven(optionsOfDisplay(a), kWhy);
}

void runModel(const RelightOptions& a) {
  constexpr const char* kWhy = "has no effect on a model; leave it out";
  refuseGiven({{!a.preview.empty(), "--preview"},
               {a.isOfPhotographs(), "--images"},
               {a.irradiance != "1", "--irradiance"},
               {!a.pixel.empty(), "--reflectance-function"},
               {a.memory.has_value(), "--memory"},
               {a.domain != "auto", "--domain"},
               {a.keepLight != "100%", "--keep-light"}},
              kWhy);
  refuseGiven(optionsOfDisplay(a), kWhy);
  if (a.probes.size() != 1) throwInput("--probe: give one");
  if (a.out.empty()) throwInput("--output: needs a name");
  runRelightModel(a);
}

void check(const RelightOptions& a) {
  refuseGiven({{a.white.has_value(), "--white"},
               {!a.view.empty(), "--view"},
               {a.allowsExternal, "--allow-external"}},
              "needs a model with transfer, .glb or .gltf");
  if (!a.isOfPhotographs()) refuseGiven({{a.irradiance != "1", "--irradiance"}}, "is for --images");
  if (a.isOfPhotographs() != a.stage.empty())
    throwInput("{}", a.stage.empty()
                         ? "STAGE: give a light stage, or photographs by --images and --directions"
                         : "--images, --directions: are in place of a light stage; give one");
  if (a.isOfPhotographs() && (a.images.empty() || a.directions.empty()))
    throwInput("--images, --directions: go together");
  if (a.probes.empty() == a.pixel.empty())
    throwInput("--probe, --reflectance-function: give one of the two");
  parseColor(a.scale, "--probe-scale");
  parseToneOperator(a.tone);
  if (!std::isfinite(a.exposure)) throwInput("--exposure: must be a finite number of stops");
  a.preview.empty() ? checkOutput(a) : checkPreview(a);
}

void run(const RelightOptions& a) {
  if (a.isOfModel()) return runModel(a);
  check(a);
  if (!a.preview.empty()) return runRelightPreview(a);
  a.pixel.empty() ? runRelitPicture(a) : runReflectanceFunction(a);
}

}  // namespace

void addRelightCommand(Command app) {
  auto [command, a] = app.addCommand<RelightOptions>(
      "relight", "Light a light stage, or a model with transfer, by a probe", run);
  command.addOption("STAGE", a.stage, "the light stage or model, from `chromeball basis`");
  command.addOption("--images", a.images,
                    "in place of STAGE: a folder of linear photographs of a subject, each under "
                    "light from one direction");
  command.addOption("--directions", a.directions,
                    "a .csv of these: FILE,X,Y,Z or FILE,AZIMUTH,ELEVATION (degrees) on each line");
  command.addWithDefault("--irradiance", a.irradiance,
                         "of these: what the lamp puts on a surface that faces it");
  command.addOption("--probe", a.probes, "the light; with --preview several, each by --probe")
      .typeName("TEXT")
      .takesAll();
  command.addWithDefault("--probe-mapping", a.mapping, "of the probe; auto detects it");
  addRotationOption(command, a.rotation);
  command.addWithDefault("--probe-scale", a.scale, "X or R,G,B: factor of the probe");
  command.addWithDefault("--domain", a.domain,
                         "where the sum is made: pixel, dct (lat-long), haar (cube), sh; the "
                         "result is the same, unless some is left out");
  command.addWithDefault(
      "--keep", a.keep,
      "PERCENT of the stage's numbers in that domain to keep, the largest; prints the error. Of a "
      "model: how many of the light's coefficients to keep, or PERCENT%");
  command.addWithDefault("--keep-light", a.keepLight,
                         "PERCENT of the light's numbers in that domain to keep, the largest");
  command.addOption("--reflectance-function", a.pixel,
                    "X,Y: in place of a probe, what this pixel reflects of light from each "
                    "direction, as a lat-long map");
  command.addOption("-o,--output", a.out,
                    "the image to write: .exr, .hdr, .pfm or .png; of a model .glb or .gltf");
  command
      .addFlagWithValue(
          "--preview",
          [&port = a.preview](const std::string& word) { port = word == "true" ? "0" : word; },
          "in place of an output: a page at http://127.0.0.1:PORT/ (any free port without one) on "
          "which the probes are turned and swapped")
      .typeName("[=PORT]");
  command.addOption("--white", a.white,
                    "of a model: the light that its white stands for; without it, the smallest "
                    "power of two, from 1 up, that clips nothing");
  command.addOption("--view", a.view, "X,Y,Z: the eye, of a model with glossy transfer");
  command.addFlag("--allow-external", a.allowsExternal,
                  "of a model: read files outside of its folder");
  command.addOption("--memory", a.memory,
                    "GB: a stage that takes more is read in bands; else 0.8 times the machine's");
  command.addOption("--exposure", a.exposure, "of a .png, in stops");
  command.addWithDefault("--tonemap", a.tone,
                         fmt::format("of a .png: {}", fmt::join(toneOperatorNames(), ", ")));
}

}  // namespace chromeball
