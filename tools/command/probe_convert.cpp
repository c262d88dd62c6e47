// SPDX-License-Identifier: Apache-2.0
// chromeball probe convert IN OUT --to MAPPING
#include <algorithm>
#include <optional>

#include "base/error.h"
#include "commands.h"
#include "front/arguments.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "image_files.h"
#include "messages.h"
#include "probe/convert.h"
#include "probe/edit.h"
#include "probe/load.h"
#include "probe_options.h"
#include "progress_bar.h"

namespace chromeball {
namespace {

struct ProbeConvertArguments {
  std::string in, out, to, from = "auto", size, scale;
  Rotation rotation;
  bool flip = false;
};

// The mapping and size of the output. Without a size, crosses and strips are vertical.
std::pair<Mapping, ImageSize> target(const ProbeConvertArguments& arguments, const Image& latLong) {
  if (!arguments.size.empty()) {
    const ImageSize size = checkedSize(arguments.out, parseSize(arguments.size, "--size"));
    if (const auto mapping = parseMapping(arguments.to, size.width, size.height, "--to"))
      return {*mapping, size};
  }
  const Mapping mapping = parseMapping(arguments.to, "--to");
  return {mapping, checkedSize(arguments.out, sizeFor(mapping, {latLong.width, latLong.height}))};
}

void warnOfSource(const LoadedProbe& probe, const ProbeConvertArguments& arguments) {
  if (probe.mapping == Mapping::MirrorBall && !arguments.flip)
    warn(
        "{}: read as an ideal mirror ball; a photograph of a ball is mirrored and "
        "shows its camera in the centre: use --flip, or `probe assemble`",
        arguments.in);
  const std::optional<Fisheye> lens = probe.mapping.disc();
  if (!lens) return;
  const double share = lens->solidAngle() / (4 * kPiD);
  if (share < 1 - 1e-9)
    warn("{}: shows {:.3g}% of the sphere; the rest is black", arguments.in, 100 * share);
}

void run(const ProbeConvertArguments& arguments) {
  checkWritable(arguments.out);
  checkDistinct({arguments.out}, {arguments.in});
  const Rgb scale = arguments.scale.empty() ? Rgb(1) : parseColor(arguments.scale, "--probe-scale");
  LoadedProbe probe = openProbe(arguments.in, arguments.from, "--probe-mapping");
  warnOfSource(probe, arguments);
  if (arguments.flip) mirrorLeftAndRight(probe.latLong);
  const auto [mapping, size] = target(arguments, probe.latLong);
  multiply(probe.latLong, scale);
  if (!std::ranges::all_of(probe.latLong.texels, [](float x) { return std::isfinite(x); }))
    throwInput("{}: a texel times the scale exceeds the range of a float", arguments.in);
  std::optional<BusyLine> busy("converting");
  const Image converted =
      convert(probe.latLong, Mapping::LatLong, mapping, size, arguments.rotation);
  busy.reset();
  writeProbe(arguments.out, converted, mapping);
}

}  // namespace

void addProbeConvertCommand(Command probe) {
  auto [command, a] = probe.addCommand<ProbeConvertArguments>(
      "convert", "Resample a probe into another mapping or size.", run);
  command.addRequired("IN", a.in, "the probe's image");
  command.addRequired("OUT", a.out, "the image to write: .exr, .hdr, .pfm or .png");
  command.addRequired("--to", a.to,
                      "lat-long, angular, mirror-ball, cube-cross, cube-strip, cube-3x2 or "
                      "fisheye[:FOV[:PROJECTION]], by default :180:equidistant; or equisolid, "
                      "orthographic, stereographic");
  command.addOption("--probe-mapping", a.from, "the mapping of IN; auto detects it");
  command.addOption("--size", a.size, "WIDTHxHEIGHT; else the size that keeps the detail");
  addRotationOption(command, a.rotation);
  command.addOption("--probe-scale", a.scale, "X or R,G,B: multiply all radiance");
  command.addFlag("--flip", a.flip,
                  "mirror IN left and right first: a photograph of a mirror ball. Its centre then "
                  "shows the camera: with the camera on +Z, turn by --probe-rotation 180");
}

}  // namespace chromeball
