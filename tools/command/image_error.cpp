// SPDX-License-Identifier: Apache-2.0
// chromeball image error A B
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "base/error.h"
#include "base/text.h"
#include "commands.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "image_files.h"
#include "json_values.h"
#include "measure/false_color.h"
#include "measure/image_error.h"
#include "messages.h"

namespace chromeball {
namespace {

struct ImageErrorArguments {
  std::string a, b, output, map = "relative";
  bool json = false, flip = false;
};

struct Findings {
  ImageError error;
  std::optional<double> flip;  // mean
};

JsonValue toJson(const Findings& findings) {
  const ImageError& error = findings.error;
  JsonValue json = {{"mse", orNull(error.mse)},   {"relmse", orNull(error.relMse)},
                    {"bias", orNull(error.bias)}, {"max_difference", orNull(error.maxDifference)},
                    {"psnr", orNull(error.psnr)}, {"invalid", error.invalid}};
  if (const auto& z = error.zScores)
    json["z"] = {{"count", z->count},
                 {"mean", orNull(z->mean)},
                 {"sd", orNull(z->standardDeviation)},
                 {"beyond_3_sigma", orNull(z->fractionBeyond3)},
                 {"largest", orNull(z->largest)},
                 {"p_value", orNull(z->pValue)}};
  if (findings.flip) json["flip"] = *findings.flip;
  return json;
}

void print(const Findings& findings) {
  const ImageError& error = findings.error;
  say("mse             {:.6g}\n", error.mse);
  say("relmse          {:.6g}\n", error.relMse);
  say("bias            {:.6g}\n", error.bias);
  say("max difference  {:.6g}\n", error.maxDifference);
  say("psnr            {:.4g} dB\n", error.psnr);
  if (error.invalid > 0) say("invalid         {} numbers left out\n", error.invalid);
  if (findings.flip) say("flip            {:.6g}\n", *findings.flip);
  if (const auto& z = error.zScores)
    say("z               mean {:.4g}, sd {:.4g}, {:.4g}% beyond 3 sigma (expected 0.27%), of {} "
        "numbers; maximum {:.3g}, p-value {:.2g}\n",
        z->mean, z->standardDeviation, 100 * z->fractionBeyond3, z->count, z->largest, z->pValue);
}

struct Side {
  Image color;
  std::optional<Image> variance;
  bool isDisplayReferred;  // of integers; FLIP compares others at several exposures

  explicit Side(const std::string& path) {
    ImageFile file = openImageFile(path);
    variance = layerOf(file, "variance", path);
    if (variance && layerOf(file, "noisy", path)) {
      variance.reset();
      warn(path + ": is denoised, and `variance` is that of its layer `noisy`: not used");
    }
    isDisplayReferred = file.integers;
    color = colorOf(std::move(file), path);
  }
  const Image* varianceOrNull() const { return variance ? &*variance : nullptr; }
};

Image flipOf(const Side& a, const Side& b) {
  return a.isDisplayReferred && b.isDisplayReferred ? flip(b.color, a.color)
                                                    : hdrFlip(b.color, a.color);
}

// A false-color image; prints its scale.
void writeMap(const ImageErrorArguments& arguments, const Image& map) {
  constexpr double kDecades = 3, kMaxZ = 5;
  const bool logarithmic = arguments.map == "relative";
  const double maximum = arguments.map == "flip" ? 1
                         : arguments.map == "z"  ? kMaxZ
                                                 : roundUp(percentile(map.texels, 0.99));
  Image colors(map.width, map.height, 3);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const double number = *map.at(x, y);
      const Color8 color =
          heatColor(logarithmic ? logLevel(number, maximum, kDecades) : number / maximum);
      for (int c = 0; c < 3; ++c) colors.at(x, y)[c] = srgbToLinear(float(color[size_t(c)]) / 255);
    }
  print(writeImage(arguments.output, colors));
  if (!arguments.json)
    say("map             {}, {} from black {:g} to yellow {:g}\n", arguments.map,
        logarithmic ? "logarithmic" : "linear", logarithmic ? maximum * std::pow(10, -kDecades) : 0,
        maximum);
}

void run(const ImageErrorArguments& arguments, const Command& command) {
  static constexpr std::array<std::string_view, 3> kMaps = {"relative", "z", "flip"};
  if (std::find(kMaps.begin(), kMaps.end(), arguments.map) == kMaps.end())
    throwInput("--map: `{}` is not known; {}", arguments.map,
               didYouMean(arguments.map, {kMaps.begin(), kMaps.end()}));
  if (arguments.output.empty())
    command.refuse({"--map"},
                   "has no effect without --output; give the image to write, or leave it out");
  if (!arguments.output.empty()) checkOutputFile(arguments.output, {".png"});
  checkDistinct({arguments.output}, {arguments.a, arguments.b});
  const Side a(arguments.a), b(arguments.b);
  if (a.color.width != b.color.width || a.color.height != b.color.height)
    throwInput("{}: is {} x {}, but {} is {} x {}; only images of the same size can be compared",
               arguments.a, a.color.width, a.color.height, arguments.b, b.color.width,
               b.color.height);
  Findings findings{imageError(a.color, b.color, a.varianceOrNull(), b.varianceOrNull()),
                    std::nullopt};
  Image flipped;
  if (arguments.flip || arguments.map == "flip") {
    flipped = flipOf(a, b);
    double sum = 0;
    for (const float number : flipped.texels) sum += number;
    findings.flip = sum / double(flipped.texels.size());
  }
  if (arguments.map == "z" && !findings.error.zScores)
    throwInput("--map: neither {} nor {} has a variance layer; render with --aov variance",
               arguments.a, arguments.b);
  arguments.json ? printJson(toJson(findings)) : print(findings);
  if (!arguments.output.empty())
    writeMap(arguments, arguments.map == "flip" ? flipped
                        : arguments.map == "z"
                            ? zScoreImage(a.color, b.color, a.varianceOrNull(), b.varianceOrNull())
                            : relativeErrorImage(a.color, b.color));
}

}  // namespace

void addImageErrorCommand(Command image) {
  auto [command, a] = image.addCommand<ImageErrorArguments>(
      "error", "The error of image A against the reference B.", run);
  command.addRequired("A", a.a, "The image");
  command.addRequired("B", a.b, "The reference image");
  command.addFlag("--json", a.json, "Print JSON");
  command.addFlag("--flip", a.flip,
                  "Also the perceived difference FLIP (Andersson et al. 2020, 2021), 0 to 1");
  command.addOption("-o,--output", a.output, "Write the error in false colors, .png");
  command.addWithDefault(
      "--map", a.map,
      "What --output shows: relative (error), z (in sigmas, needs variance layers) or flip");
}

}  // namespace chromeball
