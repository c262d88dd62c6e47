// SPDX-License-Identifier: Apache-2.0
// chromeball probe align A B
#include <cstdio>
#include <optional>

#include "base/error.h"
#include "commands.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "image_files.h"
#include "json_values.h"
#include "messages.h"
#include "probe/capture/align.h"
#include "probe/convert.h"
#include "probe/load.h"
#include "progress_bar.h"

namespace chromeball {
namespace {

struct ProbeAlignArguments {
  std::string first, second, out, firstMapping = "auto", secondMapping = "auto";
  bool json = false;
};

// Correlation: a bright sky over dark ground alone gives 0.5 to 0.75, probes of one place above
// 0.9.
constexpr double kAgrees = 0.8;

bool agrees(const ProbeFit& fit) { return fit.correlation >= kAgrees; }

JsonValue toJson(const ProbeFit& fit) {
  const Rotation::Angles angles = fit.rotation.angles();
  const glm::dquat q = fit.rotation.quaternion();
  return {{"yaw", angles.yaw},
          {"pitch", angles.pitch},
          {"roll", angles.roll},
          {"quaternion", {q.x, q.y, q.z, q.w}},
          {"correlation", fit.correlation}};
}

JsonValue toJson(const ProbeAlignArguments& arguments, const ProbeAlignment& alignment) {
  JsonValue json = {{"a", arguments.first}, {"b", arguments.second}};
  json.update(toJson(static_cast<const ProbeFit&>(alignment)));
  const dvec3& errors = alignment.standardErrors;
  json["standard_error"] = alignment.standardError();
  json["standard_errors_xyz"] = vectorToJson(errors);
  json["agrees"] = agrees(alignment);
  json["ambiguous"] = !alignment.others.empty();
  json["axis"] = alignment.axis ? vectorToJson(*alignment.axis) : JsonValue();
  json["others"] = JsonValue::array();
  for (const ProbeFit& fit : alignment.others) json["others"].push_back(toJson(fit));
  return json;
}

std::string text(const Rotation::Angles& angles) {
  return fmt::format("{:.4f},{:.4f},{:.4f}", angles.yaw, angles.pitch, angles.roll);
}

void print(const ProbeAlignment& alignment) {
  const Rotation::Angles angles = alignment.rotation.angles();
  const glm::dquat q = alignment.rotation.quaternion();
  say("rotation         yaw {:.4f}, pitch {:.4f}, roll {:.4f} degrees: B as A sees it\n",
      angles.yaw, angles.pitch, angles.roll);
  say("quaternion       {:.7f} {:.7f} {:.7f} {:.7f} (x y z w)\n", q.x, q.y, q.z, q.w);
  say("standard error   {:.2g} degrees\n", alignment.standardError());
  say("correlation      {:.4f} of the log radiance\n", alignment.correlation);
}

void warnOfDoubt(const ProbeAlignment& alignment) {
  if (const size_t count = alignment.others.size()) {
    const auto& axis = alignment.axis;
    const std::string where =
        axis ? fmt::format(", all turned about the axis ({:.3f}, {:.3f}, {:.3f})", axis->x, axis->y,
                           axis->z)
             : "";
    warn("ambiguous: {} other rotation{} as well, such as {}{}", count,
         count == 1 ? " fits" : "s fit", text(alignment.others[0].rotation.angles()), where);
  }
  if (!agrees(alignment))
    warn(
        "found no agreement: the correlation is {:.2g}, and above 0.9 where both show one place; "
        "the rotation is only the best of bad ones",
        alignment.correlation);
}

Image loadAligned(const std::string& file, const std::string& mapping, const char* option) {
  LoadedProbe probe = openProbe(file, mapping, option);
  return std::move(probe.latLong);
}

void run(const ProbeAlignArguments& arguments) {
  if (!arguments.out.empty()) {
    checkWritable(arguments.out);
    checkDistinct({arguments.out}, {arguments.first, arguments.second});
  }
  const Image first = loadAligned(arguments.first, arguments.firstMapping, "--probe-mapping-a");
  const Image second = loadAligned(arguments.second, arguments.secondMapping, "--probe-mapping-b");
  std::optional<BusyLine> busy("aligning");
  const ProbeAlignment alignment = alignProbes(first, second, arguments.first, arguments.second);
  busy.reset();
  arguments.json ? printJson(toJson(arguments, alignment)) : print(alignment);
  std::fflush(stdout);
  warnOfDoubt(alignment);
  if (!arguments.out.empty())
    writeProbe(arguments.out, convert(second, Mapping::LatLong, Mapping::LatLong,
                                      {second.width, second.height}, alignment.rotation));
}

}  // namespace

void addProbeAlignCommand(Command probe) {
  auto [command, a] = probe.addCommand<ProbeAlignArguments>(
      "align", "Find the rotation that makes one probe of a place agree with another.", run);
  command.addRequired("A", a.first, "a probe");
  command.addRequired("B", a.second, "the probe to turn");
  command.addOption("-o,--output", a.out, "write B, turned, as a lat-long map");
  command.addFlag("--json", a.json, "print JSON");
  command.addOption("--probe-mapping-a,--mapping-a", a.firstMapping,
                    "the mapping of A; auto detects it");
  command.addOption("--probe-mapping-b,--mapping-b", a.secondMapping,
                    "the mapping of B; auto detects it");
  command.footer(
      "render takes the angles or the quaternion as --probe-rotation of B. The probes may differ "
      "in exposure, white balance, size and noise.\n");
}

}  // namespace chromeball
