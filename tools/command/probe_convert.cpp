// SPDX-License-Identifier: Apache-2.0
// chromeball probe convert IN OUT --to MAPPING
#include <optional>

#include "base/error.h"
#include "busy_line.h"
#include "image/io/write_image.h"
#include "job/arguments.h"
#include "job/output_file.h"
#include "messages.h"
#include "probe/convert.h"
#include "probe/load.h"
#include "probe_commands.h"
#include "write_probe.h"

namespace chromeball {
namespace {

struct Arguments {
  std::string in, out, to, from = "auto", size;
  float rotation = 0;
};

// The mapping and size of the output. Without a size, crosses and strips are vertical.
std::pair<Mapping, ImageSize> target(const Arguments& arguments, const Image& latLong) {
  if (!arguments.size.empty()) {
    const ImageSize size = parseSize(arguments.size, "--size");
    if (const auto mapping = parseMapping(arguments.to, size.width, size.height, "--to"))
      return {*mapping, size};
  }
  for (const Mapping mapping : {Mapping::LatLong, Mapping::AngularMap, Mapping::MirrorBall,
                                Mapping::VerticalCross, Mapping::VerticalStrip, Mapping::CubeGrid})
    if (mappingName(mapping) == arguments.to)
      return {mapping, sizeFor(mapping, {latLong.width, latLong.height})};
  throwInput(
      "--to: `{}` should be lat-long, angular, mirror-ball, cube-cross, cube-strip or cube-3x2",
      arguments.to);
}

void run(const Arguments& arguments) {
  checkWritable(arguments.out);
  checkDistinct({arguments.out}, {arguments.in});
  if (!std::isfinite(arguments.rotation)) throwInput("--rotation: should be a number of degrees");
  const LoadedProbe probe = loadProbe(arguments.in, arguments.from, "--from");
  for (const std::string& warning : warnings(probe, arguments.in)) warn(warning);
  const auto [mapping, size] = target(arguments, probe.latLong);
  std::optional<BusyLine> busy("converting");
  const Image converted =
      convert(probe.latLong, Mapping::LatLong, mapping, size, arguments.rotation);
  busy.reset();
  writeProbe(arguments.out, converted);
}

}  // namespace

void addProbeConvertCommand(CLI::App& probe) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      probe.add_subcommand("convert", "Resample a probe into another mapping or size.");
  command->add_option("IN", arguments->in, "the probe's image")->required();
  command->add_option("OUT", arguments->out, "the image to write: .exr, .hdr, .pfm or .png")
      ->required();
  command
      ->add_option("--to", arguments->to,
                   "lat-long, angular, mirror-ball, cube-cross, cube-strip or cube-3x2")
      ->required();
  command->add_option("--from", arguments->from, "the mapping of IN; auto detects it");
  command->add_option("--size", arguments->size,
                      "WIDTHxHEIGHT; else the size that keeps the detail");
  command->add_option("--rotation", arguments->rotation,
                      "degrees about +Y, counter-clockwise seen from above");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace chromeball
