// SPDX-License-Identifier: Apache-2.0
// chromeball image develop IN.exr OUT.png --bloom .75:1,.25:32 --vignette .4
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "commands.h"
#include "display_options.h"
#include "front/arguments.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "image_files.h"
#include "messages.h"
#include "session/develop_image.h"

namespace chromeball {
namespace {

bool isNumber(const std::string& text) {
  double number = 0;
  return toNumber(text, number);
}

struct OpticsOption {
  std::string_view name;
  std::optional<std::string> value = {};
};

struct ImageDevelopArguments {
  std::string in, out;
  Settings display;
  // The steps in the order in which they are applied; the last also takes a file.
  std::vector<OpticsOption> optics = {{"clip"},  {"depth-blur"}, {"motion"},
                                      {"bloom"}, {"glare"},      {"vignette"}};
  std::optional<double> fov;
  bool exact = false;

  // A file in place of the strength of the vignette; empty: none.
  std::string falloff() const {
    const auto& vignette = optics.back().value;
    return vignette && !isNumber(*vignette) ? *vignette : "";
  }
};

Image readFalloff(const std::string& path) {
  Image falloff = openImage(path);
  for (const float texel : falloff.texels)
    if (!(texel >= 0) || !std::isfinite(texel))
      throwInput("--vignette: {}: has texels that are negative, infinite or NaN; they are factors",
                 path);
  return falloff;
}

DevelopSettings settingsOf(const ImageDevelopArguments& arguments) {
  DevelopSettings settings;
  for (const auto& [name, value] : arguments.optics)
    if (name == "vignette" && !arguments.falloff().empty())
      settings.falloff = readFalloff(arguments.falloff());
    else if (value)
      setDevelop(settings, name, *value, fmt::format("--{}", name));
  if (arguments.exact) settings.method = GaussianMethod::Exact;
  return settings;
}

bool isPng(const ImageDevelopArguments& arguments) {
  return lowerExtension(arguments.out) == ".png";
}

void checkDisplay(const ImageDevelopArguments& arguments, const DevelopSettings& settings) {
  if (isPng(arguments)) return;
  for (const char* name : {"output.tonemap", "output.white_balance"})
    if (arguments.display.has(name))
      throwInput("{}: {} is linear; tone mapping is for .png", arguments.display.location(name),
                 arguments.out);
  if (arguments.display.has("output.exposure") && !settings.clip)
    throwInput("--exposure: {} is linear, and nothing is clipped; leave it out", arguments.out);
}

// Exposes an image that is written as radiance only to clip it, where that was asked for.
DisplayTransform transformOf(const ImageDevelopArguments& arguments, const ImageFile& file) {
  if (isPng(arguments) || arguments.display.has("output.exposure"))
    return displayOf(arguments.display, file, arguments.in);
  return {};
}

void checkEffects(const ImageDevelopArguments& arguments, const DevelopSettings& settings) {
  if (arguments.exact && settings.bloom.empty() && !settings.glare)
    throwInput("--exact: has no effect without --bloom or --glare");
  if (arguments.fov && !settings.needsFov())
    throwInput("--fov: has no effect without --vignette STRENGTH, --glare or --depth-blur");
}

ViewFrame frameOf(const ImageDevelopArguments& arguments, const ImageFile& file,
                  const DevelopSettings& settings) {
  ViewFrame frame = viewFrame(file.image, file.placement, file.metadata);
  if (arguments.fov) {
    if (!(*arguments.fov > 0 && *arguments.fov < 180))
      throwInput("--fov: {} should be between 0 and 180 degrees", *arguments.fov);
    frame.fov = *arguments.fov;
  }
  if (settings.needsFov() && !(frame.fov > 0))
    throwInput(
        "{}: vignette, glare and depth blur need the camera's field of view, which the file does "
        "not have; give --fov DEGREES (vertical)",
        arguments.in);
  return frame;
}

Image depthOf(const ImageFile& file, const std::string& path) {
  std::optional<Image> depth = findLayer(file, "depth");
  if (!depth || depth->channels != 1)
    throwInput("--depth-blur: {} has no layer `depth`; `render --aov depth` writes one", path);
  return *std::move(depth);
}

// "bloom=.75:1,.25:32 vignette=.4", after the steps applied to the image before.
std::string historyOf(const ImageDevelopArguments& arguments, const Metadata& metadata) {
  std::string history;
  if (const auto earlier = metadata.find("developed"); earlier != metadata.end())
    if (const auto* text = std::get_if<std::string>(&earlier->second)) history = *text + "; then";
  for (const auto& [name, value] : arguments.optics)
    if (value) history += fmt::format("{}{}={}", history.empty() ? "" : " ", name, *value);
  return history + (arguments.exact ? " exact" : "");
}

// The layers needed from a file; others are not kept in memory.
struct Input {
  OutputImage image;  // the color alone
  std::vector<std::string> otherLayers;
  Image depth;  // empty unless needed
  ViewFrame frame;
  DisplayTransform transform;
};

Input readInput(const ImageDevelopArguments& arguments, const DevelopSettings& settings) {
  ImageFile file = openImageFile(arguments.in);
  Input input;
  input.frame = frameOf(arguments, file, settings);
  if (settings.lens) input.depth = depthOf(file, arguments.in);
  input.transform = transformOf(arguments, file);
  input.image.metadata = keptMetadata(file.metadata, arguments.in, arguments.out);
  if (!settings.isEmpty()) input.image.metadata["developed"] = historyOf(arguments, file.metadata);
  input.otherLayers = layerNames(file);
  input.image.placement = file.placement;
  Image color = colorAndAlphaOfData(std::move(file), arguments.in);
  input.image.layers.push_back({"", color.channels == 4 ? "RGBA" : "RGB", std::move(color)});
  return input;
}

void run(const ImageDevelopArguments& arguments) {
  checkWritable(arguments.out);
  checkDistinct({arguments.out}, {arguments.in, arguments.falloff()});
  DevelopSettings settings = settingsOf(arguments);
  checkDisplay(arguments, settings);
  checkEffects(arguments, settings);
  Input input = readInput(arguments, settings);
  if (settings.clip) *settings.clip *= std::exp2(-input.transform.exposure);
  Image& color = input.image.layers.front().image;
  print(inWords(develop(color, settings, &input.depth, input.frame)));
  if (!input.otherLayers.empty() && lowerExtension(arguments.out) == ".exr")
    print(Messages{makeNote("{}: its colour alone is developed and written; without the layers {}",
                            arguments.in, fmt::join(input.otherLayers, ", "))});
  writeKept(arguments.out, std::move(input.image), arguments.in, input.transform);
}

}  // namespace

void addImageDevelopCommand(Command image) {
  auto [command, a] = image.addCommand<ImageDevelopArguments>(
      "develop",
      "Show an HDR image through the optics of a camera: blur, streaks and vignetting before tone "
      "mapping. In the order of the options.",
      run);
  command.addRequired("IN", a.in, "The image, linear");
  command.addRequired("OUT", a.out,
                      "The image to write: .png (tone mapped), or .exr, .hdr or .pfm (linear)");
  const auto add = [&options = command, &optics = a.optics](const char* name, const char* type,
                                                            const char* help) {
    const auto found = std::ranges::find(optics, name, &OpticsOption::name);
    options.addOption(std::string("--") + name, found->value, help).typeName(type);
  };
  add("clip", "X",
      "Clip red, green and blue at X times white (after --exposure) first: what a blurred image of "
      "low dynamic range would be");
  add("depth-blur", "FOCUS:APERTURE",
      "Blur by the layer `depth` as a lens of this diameter, focused at this distance, both in "
      "metres, would");
  add("motion", "LENGTH@ANGLE",
      "Blur along a line of LENGTH pixels, ANGLE degrees counter-clockwise from the right");
  add("bloom", "WEIGHT:SIGMA,...",
      "A sum of Gaussian blurs, sigma in pixels; the weights sum to 1: .75:1,.15:8,.07:32,.03:128");
  add("glare", "spencer", "The blur of the human eye by day (Spencer et al. 1995); needs the fov");
  add("vignette", "STRENGTH|FILE",
      "Multiply by 1 - STRENGTH (1 - cos^4 of the angle to the axis), or by an image that is "
      "stretched over the picture");
  command.addOption(
      "--fov", a.fov,
      "Vertical field of view in degrees, of the whole picture; without it that of the .exr");
  command.addFlag("--exact", a.exact,
                  "Use the exact kernels for all Gaussians: slow, the reference");
  addDisplayOptions(command, a.display);
}

}  // namespace chromeball
