// SPDX-License-Identifier: Apache-2.0
// chromeball probe info FILE
#include <cstdio>

#include "base/error.h"
#include "commands.h"
#include "json_values.h"
#include "messages.h"
#include "probe/info.h"
#include "probe/load.h"
#include "probe/mapping.h"
#include "probe_options.h"

namespace chromeball {
namespace {

struct ProbeInfoArguments {
  std::string file, mapping = "auto";
  Rotation rotation;
  bool json = false, mappingReport = false;
};

JsonValue toJson(const LoadedProbe& probe, const ProbeInfo& info, const std::string& file) {
  JsonValue suns = JsonValue::array(), shares = JsonValue::array();
  for (const Sun& sun : info.suns)
    suns.push_back({{"direction", vectorToJson(sun.direction)},
                    {"irradiance", vectorToJson(sun.irradiance)},
                    {"angle", sun.angle}});
  for (const auto& [count, fraction] : info.brightestTexels)
    shares.push_back({{"texels", count}, {"share", fraction}});
  return {{"file", file},
          {"width", probe.fileWidth},
          {"height", probe.fileHeight},
          {"mapping", mappingName(probe.mapping)},
          {"mapping_guessed", probe.detected},
          {"mapping_reason", probe.detected ? probe.reason : "given"},
          {"turned", probe.turned},
          {"lat_long", {{"width", probe.latLong.width}, {"height", probe.latLong.height}}},
          {"min", vectorToJson(info.min)},
          {"mean", vectorToJson(info.mean)},
          {"max", vectorToJson(info.max)},
          {"share_at_max", probe.fractionAtMaximum},
          {"dynamic_range", info.dynamicRange},
          {"max_over_mean", info.maxOverMean},
          {"robust_range", orNull(info.robustRange)},
          {"plateau",
           {{"texels", info.plateau.texels},
            {"solid_angle", info.plateau.solidAngle},
            {"looks_clipped", info.plateau.looksClipped}}},
          {"lost_if_clipped_at_white", info.lostIfClippedAtWhite},
          {"invalid_texels",
           {{"nan", probe.repair.nan},
            {"infinite", probe.repair.infinite},
            {"negative", probe.repair.negative},
            {"first", probe.repair.total() > 0 ? JsonValue{probe.repair.firstX, probe.repair.firstY}
                                               : JsonValue(nullptr)}}},
          {"mean_radiance", vectorToJson(info.meanRadiance)},
          {"brightest",
           {{"direction", vectorToJson(info.brightestDirection)},
            {"radiance", vectorToJson(info.brightest)}}},
          {"suns", suns},
          {"brightest_shares", shares}};
}

template <class Vector>
std::string triple(const Vector& v) {
  return fmt::format("{:.6g} {:.6g} {:.6g}", v.x, v.y, v.z);
}

JsonValue toJson(const TexelSolidAngles& angles) {
  return {{"min_solid_angle", angles.min},
          {"max_solid_angle", angles.max},
          {"max_over_min", angles.max / angles.min},
          {"texels", angles.texels}};
}

void print(const LoadedProbe& probe, const TexelSolidAngles& angles) {
  const double all = double(probe.fileWidth) * probe.fileHeight;
  fmt::print("solid angle      {:.5g} to {:.5g} sr per texel of the file, {:.4g} : 1\n", angles.min,
             angles.max, angles.max / angles.min);
  fmt::print("texels in use    {} of {}, {:.4g}%\n", angles.texels, all,
             100 * double(angles.texels) / all);
}

std::string robustText(double range) {
  if (range == 0) return "none: less than 1% of the sphere is lit";
  if (!std::isfinite(range)) return "infinite: more than 1% of the sphere is black";
  return fmt::format("{:.3g} : 1, without 1% of the sphere at either end", range);
}

void print(const LoadedProbe& probe, const ProbeInfo& info) {
  fmt::print("resolution       {} x {}\n", probe.fileWidth, probe.fileHeight);
  fmt::print("mapping          {} ({})\n", mappingName(probe.mapping),
             probe.detected ? "detected: " + probe.reason : "given");
  if (probe.turned)
    fmt::print("turned           by 180 degrees: its `envmap` attribute puts +Z in the centre\n");
  if (probe.mapping != Mapping::LatLong)
    fmt::print("as lat-long      {} x {}, which the following describes\n", probe.latLong.width,
               probe.latLong.height);
  fmt::print("min RGB          {}\nmean RGB         {}\nmax RGB          {}\n", triple(info.min),
             triple(info.mean), triple(info.max));
  fmt::print("at the maximum   {:.3g}% of the file's texels\n", 100 * probe.fractionAtMaximum);
  fmt::print("dynamic range    {:.4g} : 1\n", info.dynamicRange);
  fmt::print("max / mean       {:.4g} of the luminance\n", info.maxOverMean);
  fmt::print("robust range     {}\n", robustText(info.robustRange));
  fmt::print(
      "plateau          {} texel{}, {:.3g} sr, within 0.2% of the maximum{}\n", info.plateau.texels,
      info.plateau.texels == 1 ? "" : "s", info.plateau.solidAngle,
      info.plateau.looksClipped ? ": looks clipped, unless it is a lamp of even radiance" : "");
  fmt::print("clipped at white {:.3g}% of the irradiance lost, exposed for a mean of 0.18\n",
             100 * info.lostIfClippedAtWhite);
  fmt::print("invalid texels   {}\n",
             probe.repair.total() > 0 ? describe(probe.repair) + ", repaired" : "none");
  fmt::print("mean radiance    {} over the sphere\n", triple(info.meanRadiance));
  fmt::print("brightest        {} from direction {}\n", triple(info.brightest),
             triple(info.brightestDirection));
  for (const auto& [count, fraction] : info.brightestTexels)
    fmt::print("brightest {:<6} {:.3g}% of the irradiance\n", count, 100 * fraction);
  if (info.suns.empty()) fmt::print("suns             none\n");
  for (const Sun& sun : info.suns)
    fmt::print("sun              direction {}, irradiance {}, {:.3g} degrees wide\n",
               triple(sun.direction), triple(sun.irradiance), sun.angle);
}

ProbeInfo turned(ProbeInfo info, const Rotation& rotation) {
  info.brightestDirection = rotation(info.brightestDirection);
  for (Sun& sun : info.suns) sun.direction = rotation(sun.direction);
  return info;
}

void run(const ProbeInfoArguments& arguments) {
  const LoadedProbe probe = loadProbe(arguments.file, arguments.mapping, "--probe-mapping");
  print(probe.messages);
  for (const std::string& warning : lightWarnings(probe, arguments.file)) warn(warning);
  const ProbeInfo info = turned(probeInfo(probe.latLong), arguments.rotation);
  const auto angles = [&] {
    return texelSolidAngles(probe.mapping, {probe.fileWidth, probe.fileHeight});
  };
  if (arguments.json) {
    JsonValue json = toJson(probe, info, arguments.file);
    if (arguments.mappingReport) json["mapping_report"] = toJson(angles());
    printJson(json);
  } else {
    print(probe, info);
    if (arguments.mappingReport) print(probe, angles());
  }
}

}  // namespace

void addProbeInfoCommand(Command probe) {
  auto [command, a] = probe.addCommand<ProbeInfoArguments>(
      "info", "Show the mapping and the statistics of a probe.", run);
  command.addRequired("FILE", a.file,
                      "the probe's image, or a folder with the six faces of a cube map");
  command.addOption("--probe-mapping", a.mapping,
                    "auto, lat-long, angular, mirror-ball, cube-cross, cube-strip or cube-3x2");
  addRotationOption(command, a.rotation, ", and with it the directions");
  command.addFlag("--json", a.json, "print JSON");
  command.footer(
      "robust_range of the JSON is null if it is infinite, as more than 1% of the sphere is black, "
      "and 0 if less than 1% is lit.\n");
  command.addFlag("--mapping-report", a.mappingReport,
                  "also show the solid angles of the file's texels");
}

}  // namespace chromeball
