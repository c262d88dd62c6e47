// SPDX-License-Identifier: Apache-2.0
// chromeball probe reflectivity PHOTO --direct X,Y,W,H --reflected X,Y,W,H

#include "base/error.h"
#include "commands.h"
#include "front/arguments.h"
#include "image_files.h"
#include "json_values.h"
#include "messages.h"
#include "probe/capture/reflectivity.h"

namespace chromeball {
namespace {

using glm::dvec3;

struct ProbeReflectivityArguments {
  std::string photograph, direct, reflected, against, standard;
  std::optional<double> saturation;
  bool json = false;
};

struct Photograph {
  Image image;
  double saturation;  // channels from here on are clipped
};

// Integer files are clipped at white, half floats at 65504, merged photographs where they say so.
Photograph loadPhotograph(const std::string& file, const std::optional<double>& saturation) {
  constexpr double kWhite = 1, kLargestHalf = 65504;
  ImageFile read = openImageFile(file);
  const bool hasIntegers = read.integers;
  if (hasIntegers)
    warn("{}: has integer texels: {}, without the response of the camera", file,
         decodingInWords(read));
  const std::optional<Image> clipped = layerOf(read, "clipped", file);
  const double limit = saturation.value_or(hasIntegers ? kWhite : kLargestHalf);
  Image image = colorOf(std::move(read), file);
  for (size_t i = 0; clipped && i < image.pixels(); ++i)
    if (*clipped->at(i) > 0) image.setRgb(i, Rgb(float(limit)));
  return {std::move(image), limit};
}

dvec3 parseStandard(const std::string& text) {
  if (text.empty()) return dvec3(1);
  const bool isOne = text.find(',') == std::string::npos;
  const std::vector<double> c = parseNumbers(text, isOne ? 1 : 3, "--standard-reflectance");
  for (const double channel : c)
    if (!(channel > 0 && channel <= 1))
      throwInput("--standard-reflectance: {} should be above 0, up to 1", channel);
  return isOne ? dvec3(c[0]) : dvec3(c[0], c[1], c[2]);
}

bool isRectangle(const std::string& text) {
  return std::count(text.begin(), text.end(), ',') == 3 &&
         text.find_first_not_of("0123456789,-") == std::string::npos;
}

// The patch to compare with: in the photograph, or in another one.
PatchMean denominator(const ProbeReflectivityArguments& arguments, const Photograph& photograph) {
  if (isRectangle(arguments.against)) {
    if (!arguments.direct.empty())
      throwInput("--against: a rectangle takes the place of --direct; give one of them");
    return patchMean(photograph.image, parseRectangle(arguments.against, "--against"),
                     photograph.saturation, "--against");
  }
  if (arguments.direct.empty())
    throwInput("--direct: give the rectangle X,Y,WIDTH,HEIGHT to compare with");
  const PixelRectangle rectangle = parseRectangle(arguments.direct, "--direct");
  if (arguments.against.empty())
    return patchMean(photograph.image, rectangle, photograph.saturation, "--direct");
  const Photograph standard = loadPhotograph(arguments.against, arguments.saturation);
  return patchMean(standard.image, rectangle, standard.saturation, "--direct");
}

JsonValue toJson(const PatchMean& patch) {
  return {{"mean", vectorToJson(patch.mean)},
          {"standard_error", vectorToJson(patch.standardError)},
          {"pixels", patch.pixels}};
}

void run(const ProbeReflectivityArguments& arguments) {
  const dvec3 standard = parseStandard(arguments.standard);
  if (arguments.saturation && !(*arguments.saturation > 0))
    throwInput("--saturation: {} should be above 0", *arguments.saturation);
  const PixelRectangle rectangle = parseRectangle(arguments.reflected, "--reflected");
  const Photograph photograph = loadPhotograph(arguments.photograph, arguments.saturation);
  const PatchMean reflected =
      patchMean(photograph.image, rectangle, photograph.saturation, "--reflected");
  const PatchMean direct = denominator(arguments, photograph);
  const Reflectivity result = reflectivity(
      reflected, direct, standard, isRectangle(arguments.against) ? "--against" : "--direct");
  const double percent = 100 * luminance(result.value);
  if (std::max({result.value.x, result.value.y, result.value.z}) > 1)
    warn("a reflectivity above 1: are the rectangles exchanged, or lit differently?");
  if (arguments.json) {
    const JsonValue json = {{"file", arguments.photograph},
                            {"reflectivity", vectorToJson(result.value)},
                            {"standard_error", vectorToJson(result.standardError)},
                            {"percent", percent},
                            {"reflected", toJson(reflected)},
                            {"direct", toJson(direct)},
                            {"standard_reflectance", vectorToJson(standard)}};
    printJson(json);
    return;
  }
  const auto triple = [](const dvec3& v) {
    return fmt::format("{:.6g} {:.6g} {:.6g}", v.x, v.y, v.z);
  };
  fmt::print("direct          {}, the mean of {} pixels\n", triple(direct.mean), direct.pixels);
  fmt::print("reflected       {}, the mean of {} pixels\n", triple(reflected.mean),
             reflected.pixels);
  fmt::print("reflectivity    {:.4f},{:.4f},{:.4f}\n", result.value.x, result.value.y,
             result.value.z);
  fmt::print("standard error  {:.2g} {:.2g} {:.2g}\n", result.standardError.x,
             result.standardError.y, result.standardError.z);
  fmt::print("{:.0f}% reflective\n", percent);
}

}  // namespace

void addProbeReflectivityCommand(Command probe) {
  auto [command, a] = probe.addCommand<ProbeReflectivityArguments>(
      "reflectivity",
      "Measure how much a mirror ball or a paint reflects, from a photograph that shows a surface "
      "directly and in the ball, or the paint and a standard.",
      run);
  command.addRequired("PHOTO", a.photograph, "a linear image");
  command.addOption("--direct", a.direct,
                    "X,Y,WIDTH,HEIGHT in pixels: the surface seen directly, or the standard");
  command.addRequired("--reflected", a.reflected,
                      "X,Y,WIDTH,HEIGHT: the same surface in the ball, or the paint");
  command.addOption(
      "--against", a.against,
      "where the standard is: the photograph in which --direct lies, or its rectangle in PHOTO");
  command.addOption("--standard-reflectance", a.standard, "X or R,G,B of the standard; else 1");
  command.addOption(
      "--saturation", a.saturation,
      "the level from which on channels are clipped; else 1 in integer images, and 65504");
  command.addFlag("--json", a.json, "print JSON");
}

}  // namespace chromeball
