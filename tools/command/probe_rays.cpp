// SPDX-License-Identifier: Apache-2.0
// chromeball probe rays PROBE
#include <algorithm>

#include "base/error.h"
#include "commands.h"
#include "front/arguments.h"
#include "image_files.h"
#include "json_values.h"
#include "math/icosphere.h"
#include "messages.h"
#include "probe/convert.h"
#include "probe/load.h"
#include "probe/random_rays.h"
#include "probe_options.h"

namespace chromeball {
namespace {

struct ProbeRaysArguments {
  std::string file, mapping = "auto", size;
  Rotation rotation;
  double error = 0.1;
  bool json = false;
};

struct Sampling {
  const char* name;
  double RayVariance::*variance;
};
constexpr Sampling kSamplings[] = {{"uniform", &RayVariance::uniform},
                                   {"cosine", &RayVariance::cosine},
                                   {"luminance", &RayVariance::luminance}};

// Relative variances of one sampling.
struct Summary {
  double upward, median, max;
};

struct Normals {
  RayVariance upward;
  std::vector<RayVariance> lit;  // of the icosphere's, those with light
  size_t count = 0;

  Normals(const Image& latLong, const Rotation& rotation) {
    constexpr int kSubdivisions = 3;  // 1280 normals
    std::vector<vec3> normals = icosphereNormals(kSubdivisions);
    count = normals.size();
    normals.push_back(rotation.back(vec3(0, 1, 0)));
    lit = rayVariances(latLong, normals);
    upward = lit.back();
    lit.pop_back();
    std::erase_if(lit, [](const RayVariance& v) { return v.irradiance == 0; });
  }

  // There is at least one lit normal.
  Summary summary(const Sampling& sampling) const {
    std::vector<double> all;
    for (const RayVariance& v : lit) all.push_back(v.*sampling.variance);
    const auto middle = all.begin() + ptrdiff_t(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    return {upward.*sampling.variance, *middle, *std::max_element(all.begin(), all.end())};
  }
};

// A whole number in JSON where that has one.
JsonValue countOf(double rays) {
  constexpr double kLargest = 9e18;
  return rays < kLargest ? JsonValue(uint64_t(rays)) : JsonValue(rays);
}

JsonValue toJson(const ProbeRaysArguments& arguments, const Normals& normals) {
  JsonValue rays, variances;
  for (const Sampling& sampling : kSamplings) {
    JsonValue raysHere, variancesHere;
    const auto add = [&](const char* normal, double variance, bool isLit) {
      raysHere[normal] = isLit ? countOf(raysForError(variance, arguments.error)) : JsonValue();
      variancesHere[normal] = isLit ? JsonValue(variance) : JsonValue();
    };
    const bool isLit = !normals.lit.empty();
    const Summary summary = isLit ? normals.summary(sampling) : Summary{};
    add("upward", summary.upward, normals.upward.irradiance > 0);
    add("median", summary.median, isLit);
    add("max", summary.max, isLit);
    rays[sampling.name] = raysHere;
    variances[sampling.name] = variancesHere;
  }
  return {{"file", arguments.file},
          {"error", arguments.error},
          {"normals", normals.count},
          {"unlit_normals", normals.count - normals.lit.size()},
          {"rays", rays},
          {"relative_variance", variances}};
}

void print(const ProbeRaysArguments& arguments, const Normals& normals) {
  fmt::print("rays for an error of {:.4g}% of the irradiance, unoccluded\n", 100 * arguments.error);
  fmt::print("{:<10} {:>14} {:>14} {:>14}\n", "sampling", "upward", "median", "max");
  for (const Sampling& sampling : kSamplings) {
    const auto rays = [&](double variance, bool isLit) {
      return isLit ? fmt::format("{:.15g}", raysForError(variance, arguments.error)) : "no light";
    };
    const bool isLit = !normals.lit.empty();
    const Summary summary = isLit ? normals.summary(sampling) : Summary{};
    fmt::print("{:<10} {:>14} {:>14} {:>14}\n", sampling.name,
               rays(summary.upward, normals.upward.irradiance > 0), rays(summary.median, isLit),
               rays(summary.max, isLit));
  }
  if (const size_t unlit = normals.count - normals.lit.size())
    fmt::print("{} of {} normals receive no light and are left out\n", unlit, normals.count);
}

void run(const ProbeRaysArguments& arguments) {
  constexpr double kMinError = 1e-6;
  if (!(arguments.error >= kMinError && arguments.error <= 1))
    throwInput("--error: {} should be a fraction from {} to 1: 0.1 is 10%", arguments.error,
               kMinError);
  const std::optional<ImageSize> size =
      arguments.size.empty()
          ? std::nullopt
          : std::optional(checkedSize(arguments.file, parseSize(arguments.size, "--size")));
  LoadedProbe probe = openProbe(arguments.file, arguments.mapping, "--mapping");
  if (size) probe.latLong = convert(probe.latLong, Mapping::LatLong, Mapping::LatLong, *size);
  const Normals normals(probe.latLong, arguments.rotation);
  arguments.json ? printJson(toJson(arguments, normals)) : print(arguments, normals);
}

}  // namespace

void addProbeRaysCommand(Command probe) {
  auto [command, a] = probe.addCommand<ProbeRaysArguments>(
      "rays",
      "How many random rays the irradiance of an unoccluded point needs: facing up, and the median "
      "and the most of 1280 normals.",
      run);
  command.addRequired("PROBE", a.file, "the probe's image");
  command.addWithDefault("--error", a.error,
                         "the standard error of the luminance to reach, as a fraction");
  command.addOption("--size", a.size, "WIDTHxHEIGHT: reduce the probe to this lat-long map first");
  addRotationOption(command, a.rotation);
  command.addOption("--mapping", a.mapping, "the mapping of PROBE; auto detects it");
  command.addFlag("--json", a.json, "print JSON");
  command.footer(
      "Samplings:\n"
      "  uniform      directions uniform over the hemisphere\n"
      "  cosine       pdf proportional to the cosine\n"
      "  luminance    pdf proportional to the probe's luminance, over the whole sphere\n");
}

}  // namespace chromeball
