// SPDX-License-Identifier: Apache-2.0
// chromeball probe rays PROBE
#include <algorithm>
#include <array>
#include <optional>

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

constexpr const char* kRayNormals[] = {"upward", "median", "max"};

struct Sampling {
  const char* name;
  // Relative ones for each of kRayNormals, if it receives light.
  std::array<std::optional<double>, 3> variances;
};

struct RayReport {
  size_t normals, unlit;
  std::vector<Sampling> samplings;
};

RayReport reportOf(const Image& latLong, const Rotation& rotation) {
  constexpr int kSubdivisions = 3;  // 1280 normals
  std::vector<vec3> normals = icosphereNormals(kSubdivisions);
  const size_t count = normals.size();
  normals.push_back(rotation.back(vec3(0, 1, 0)));
  std::vector<RayVariance> lit = rayVariances(latLong, normals);
  const RayVariance upward = lit.back();
  lit.pop_back();
  std::erase_if(lit, [](const RayVariance& v) { return v.irradiance == 0; });
  RayReport report{count, count - lit.size(), {}};
  for (const auto& [name, variance] :
       {std::pair("uniform", &RayVariance::uniform), std::pair("cosine", &RayVariance::cosine),
        std::pair("luminance", &RayVariance::luminance)}) {
    Sampling sampling{name, {}};
    if (upward.irradiance > 0) sampling.variances[0] = upward.*variance;
    if (!lit.empty()) {
      std::vector<double> all;
      for (const RayVariance& v : lit) all.push_back(v.*variance);
      const auto middle = all.begin() + ptrdiff_t(all.size() / 2);
      std::nth_element(all.begin(), middle, all.end());
      sampling.variances[1] = *middle;
      sampling.variances[2] = *std::ranges::max_element(all);
    }
    report.samplings.push_back(sampling);
  }
  return report;
}

// A whole number in JSON where that has one.
JsonValue countOf(double rays) {
  constexpr double kLargest = 9e18;
  return rays < kLargest ? JsonValue(uint64_t(rays)) : JsonValue(rays);
}

JsonValue toJson(const ProbeRaysArguments& arguments, const RayReport& report) {
  JsonValue rays, variances;
  for (const auto& [name, ofNormals] : report.samplings)
    for (size_t i = 0; i < ofNormals.size(); ++i) {
      const std::optional<double>& variance = ofNormals[i];
      rays[name][kRayNormals[i]] =
          variance ? countOf(raysForError(*variance, arguments.error)) : JsonValue();
      variances[name][kRayNormals[i]] = orNull(variance);
    }
  return {{"file", arguments.file},
          {"error", arguments.error},
          {"normals", report.normals},
          {"unlit_normals", report.unlit},
          {"rays", rays},
          {"relative_variance", variances}};
}

void print(const ProbeRaysArguments& arguments, const RayReport& report) {
  const auto rays = [&](const std::optional<double>& variance) {
    return variance ? fmt::format("{:.15g}", raysForError(*variance, arguments.error)) : "no light";
  };
  say("rays for an error of {:.4g}% of the irradiance, unoccluded\n", 100 * arguments.error);
  say("{:<10} {:>14} {:>14} {:>14}\n", "sampling", "upward", "median", "max");
  for (const auto& [name, variances] : report.samplings)
    say("{:<10} {:>14} {:>14} {:>14}\n", name, rays(variances[0]), rays(variances[1]),
        rays(variances[2]));
  if (report.unlit > 0)
    say("{} of {} normals receive no light and are left out\n", report.unlit, report.normals);
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
  LoadedProbe probe = openProbe(arguments.file, arguments.mapping, "--probe-mapping");
  if (size) probe.latLong = convert(probe.latLong, Mapping::LatLong, Mapping::LatLong, *size);
  const RayReport report = reportOf(probe.latLong, arguments.rotation);
  arguments.json ? printJson(toJson(arguments, report)) : print(arguments, report);
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
  command.addOption("--probe-mapping", a.mapping, "the mapping of PROBE; auto detects it");
  command.addFlag("--json", a.json, "print JSON");
  command.footer(
      "Samplings:\n  uniform      directions uniform over the hemisphere\n  cosine       pdf "
      "proportional to the cosine\n  luminance    pdf proportional to the probe's luminance, over "
      "the whole sphere\n");
}

}  // namespace chromeball
