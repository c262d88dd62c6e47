// SPDX-License-Identifier: Apache-2.0
// chromeball probe synth KIND OUT
#include <algorithm>
#include <functional>
#include <map>

#include "base/error.h"
#include "base/text.h"
#include "commands.h"
#include "front/arguments.h"
#include "image/io/write_image.h"
#include "image_files.h"
#include "probe/synth.h"

namespace chromeball {
namespace {

struct ProbeSynthArguments {
  std::string kind, out, size = "1024x512", radiance = "1,1,1", texel, direction, slope = "0,1,0";
  ClearSky sky;
  bool withoutSun = false;
};

dvec3 parseVector(const std::string& text, std::string_view option) {
  const std::vector<double> v = parseNumbers(text, 3, option);
  return {v[0], v[1], v[2]};
}

Rgb parseRadiance(const ProbeSynthArguments& arguments) {
  const Rgb radiance = Rgb(parseVector(arguments.radiance, "--radiance"));
  if (!isFinite(radiance) || std::min({radiance.x, radiance.y, radiance.z}) < 0)
    throwInput("--radiance: {} should be finite and not negative", arguments.radiance);
  return radiance;
}

void checkRange(std::string_view option, double number, double min, double max) {
  if (!(number >= min && number <= max))
    throwInput("{}: {} should be {} to {}", option, number, min, max);
}

Image oneHot(const ProbeSynthArguments& arguments, const ImageSize& size) {
  int x = size.width / 2, y = size.height / 2;
  if (!arguments.texel.empty()) {
    const std::vector<double> texel = parseNumbers(arguments.texel, 2, "--texel");
    const bool inside = texel[0] >= 0 && texel[0] < size.width && texel[1] >= 0 &&
                        texel[1] < size.height && std::floor(texel[0]) == texel[0] &&
                        std::floor(texel[1]) == texel[1];
    if (!inside)
      throwInput("--texel: {} should be whole numbers inside {} x {}", arguments.texel, size.width,
                 size.height);
    x = int(texel[0]), y = int(texel[1]);
  } else if (!arguments.direction.empty()) {
    const dvec3 direction = parseVector(arguments.direction, "--direction");
    if (glm::length(direction) == 0) throwInput("--direction: should not be zero");
    const dvec2 uv = directionToUv(Mapping::LatLong, direction);
    x = std::min(int(uv.x * size.width), size.width - 1);
    y = std::min(int(uv.y * size.height), size.height - 1);
  }
  return oneHotProbe(size, x, y, parseRadiance(arguments));
}

Image gradient(const ProbeSynthArguments& arguments, const ImageSize& size) {
  const dvec3 slope = parseVector(arguments.slope, "--slope");
  if (glm::length(slope) > 1)
    throwInput("--slope: {} should be no longer than 1, so that radiance is not negative",
               arguments.slope);
  return gradientProbe(size, parseRadiance(arguments), slope);
}

using Maker = Image (*)(const ProbeSynthArguments&, const ImageSize&);

const std::map<std::string_view, Maker> kMakers = {
    {"constant", [](const ProbeSynthArguments& a,
                    const ImageSize& size) { return constantProbe(size, parseRadiance(a)); }},
    {"one-hot", oneHot},
    {"gradient", gradient},
    {"sun-sky", [](const ProbeSynthArguments& a,
                   const ImageSize& size) { return clearSkyProbe(size, a.sky, !a.withoutSun); }},
    {"overcast",
     [](const ProbeSynthArguments& a, const ImageSize& size) {
       return overcastProbe(size, parseRadiance(a), a.sky.groundAlbedo);
     }},
    {"studio",
     [](const ProbeSynthArguments&, const ImageSize& size) { return studioProbe(size); }}};

// The kinds of probe that each option is for; --size is for all.
const std::map<std::string, std::vector<std::string_view>> kKindsOf = {
    {"--radiance", {"constant", "one-hot", "gradient", "overcast"}},
    {"--texel", {"one-hot"}},
    {"--direction", {"one-hot"}},
    {"--slope", {"gradient"}},
    {"--sun-elevation", {"sun-sky"}},
    {"--sun-azimuth", {"sun-sky"}},
    {"--turbidity", {"sun-sky"}},
    {"--ground-albedo", {"sun-sky", "overcast"}},
    {"--no-sun", {"sun-sky"}}};

void checkOptions(const Command& command, const std::string& kind) {
  for (const auto& [option, kinds] : kKindsOf)
    if (command.has(option) && std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
      throwInput("{}: not an option of {}; only of {}", option, kind, fmt::join(kinds, ", "));
}

void run(const ProbeSynthArguments& arguments, const Command& command) {
  const auto maker = kMakers.find(arguments.kind);
  if (maker == kMakers.end()) {
    std::vector<std::string_view> kinds;
    for (const auto& [kind, unused] : kMakers) kinds.push_back(kind);
    throwInput("unknown kind of probe `{}`; {}", arguments.kind, didYouMean(arguments.kind, kinds));
  }
  checkOptions(command, arguments.kind);
  checkWritable(arguments.out);
  checkRange("--ground-albedo", arguments.sky.groundAlbedo, 0, 1);
  checkRange("--sun-elevation", arguments.sky.sunElevation, 0, 90);
  checkRange("--turbidity", arguments.sky.turbidity, 2, 10);
  const ImageSize size = checkedSize(arguments.out, parseSize(arguments.size, "--size"));
  writeProbe(arguments.out, maker->second(arguments, size));
}

}  // namespace

void addProbeSynthCommand(Command probe) {
  auto [command, a] =
      probe.addCommand<ProbeSynthArguments>("synth", "Make a lat-long probe from a formula.", run);
  command.addRequired("KIND", a.kind, "constant, one-hot, gradient, sun-sky, overcast or studio");
  command.addRequired("OUT", a.out, "the image to write: .exr, .hdr, .pfm or .png");
  command.addWithDefault("--size", a.size, "WIDTHxHEIGHT");
  command.addWithDefault("--radiance", a.radiance,
                         "R,G,B: of constant, one-hot's texel, gradient's mean, overcast's zenith");
  command.addOption("--texel", a.texel, "X,Y: one-hot's texel; else the middle one");
  command.addOption("--direction", a.direction, "X,Y,Z: or the one it lies in").excludes("--texel");
  command.addWithDefault("--slope", a.slope, "X,Y,Z: gradient is radiance (1 + slope . D)");
  command.addWithDefault("--sun-elevation", a.sky.sunElevation, "degrees, 0 to 90");
  command.addWithDefault("--sun-azimuth", a.sky.sunAzimuth,
                         "degrees from -Z, counter-clockwise seen from above");
  command.addWithDefault("--turbidity", a.sky.turbidity, "2 (very clear) to 10 (hazy)");
  command.addWithDefault("--ground-albedo", a.sky.groundAlbedo, "0 to 1: sun-sky, overcast");
  command.addFlag("--no-sun", a.withoutSun, "sun-sky without its sun");
}

}  // namespace chromeball
