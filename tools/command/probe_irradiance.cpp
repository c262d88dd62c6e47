// SPDX-License-Identifier: Apache-2.0
// chromeball probe irradiance IN OUT
#include <optional>

#include "base/error.h"
#include "base/text.h"
#include "commands.h"
#include "front/arguments.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "image_files.h"
#include "messages.h"
#include "probe/irradiance.h"
#include "probe/load.h"
#include "probe_options.h"
#include "progress_bar.h"

namespace chromeball {
namespace {

struct ProbeIrradianceArguments {
  std::string in, out, size, method = "exact", mapping = "auto";
  Rotation rotation;
};

void run(const ProbeIrradianceArguments& arguments) {
  checkWritable(arguments.out);
  checkDistinct({arguments.out}, {arguments.in});
  const bool exact = arguments.method == "exact";
  if (!exact && arguments.method != "sh")
    throwInput("--method: unknown method `{}`; {}", arguments.method,
               didYouMean(arguments.method, {"exact", "sh"}));
  const auto checked = [&](const ImageSize& size) {
    return checkedSize(arguments.out, size, kIrradianceCopies);
  };
  const ImageSize given =
      arguments.size.empty() ? ImageSize{0, 0} : checked(parseSize(arguments.size, "--size"));
  const LoadedProbe probe = openProbe(arguments.in, arguments.mapping, "--probe-mapping");
  const ImageSize size =
      given.width > 0 ? given : checked({probe.latLong.width, probe.latLong.height});
  std::optional<BusyLine> busy("irradiance of the probe");
  const Image irradiance = exact ? irradianceMap(probe.latLong, size, arguments.rotation)
                                 : shIrradianceMap(probe.latLong, size, arguments.rotation);
  busy.reset();
  writeProbe(arguments.out, irradiance);
}

}  // namespace

void addProbeIrradianceCommand(Command probe) {
  auto [command, a] = probe.addCommand<ProbeIrradianceArguments>(
      "irradiance", "The irradiance on surfaces of every orientation, as a lat-long map.", run);
  command.addRequired("IN", a.in, "the probe's image");
  command.addRequired("OUT", a.out, "the image to write: .exr, .hdr, .pfm or .png");
  command.addOption("--size", a.size, "WIDTHxHEIGHT; else the probe's, as lat-long");
  command.addWithDefault(
      "--method", a.method,
      "exact, or sh: spherical harmonics to order 2, 1 to 10% off, may be negative");
  addRotationOption(command, a.rotation);
  command.addOption("--probe-mapping", a.mapping, "the mapping of IN; auto detects it");
}

}  // namespace chromeball
