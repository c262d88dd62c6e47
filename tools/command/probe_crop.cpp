// SPDX-License-Identifier: Apache-2.0
// chromeball probe crop PROBE OUT --fov DEG --yaw DEG --pitch DEG
#include <cmath>

#include "base/error.h"
#include "commands.h"
#include "front/arguments.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "image_files.h"
#include "messages.h"
#include "probe/convert.h"
#include "probe/load.h"

namespace chromeball {
namespace {

struct ProbeCropArguments {
  std::string probe, out, mapping = "auto", size;
  double fov = 60;
  Rotation::Angles pose{};
};

ImageSize sizeOf(const ProbeCropArguments& arguments, const Image& latLong) {
  if (!arguments.size.empty()) return parseSize(arguments.size, "--size");
  const int rows = rowsOfCrop(latLong, arguments.fov);
  return {std::max(1, 4 * rows / 3), rows};
}

void run(const ProbeCropArguments& arguments) {
  checkWritable(arguments.out);
  checkDistinct({arguments.out}, {arguments.probe});
  if (!(arguments.fov > 0 && arguments.fov < 180))
    throwInput("--fov: {} should be above 0 and below 180 degrees", arguments.fov);
  constexpr double kMostTurn = 36000;  // a hundred turns, as of --orbit
  for (const auto& [option, angle] : {std::pair{"--yaw", arguments.pose.yaw},
                                      {"--pitch", arguments.pose.pitch},
                                      {"--roll", arguments.pose.roll}})
    if (!(std::abs(angle) <= kMostTurn))
      throwInput("{}: {} should be {} to {} degrees", option, angle, -kMostTurn, kMostTurn);
  const Rotation pose = Rotation::ofAngles(arguments.pose);
  const Image latLong = openProbe(arguments.probe, arguments.mapping, "--probe-mapping").latLong;
  const ImageSize size = checkedSize(arguments.out, sizeOf(arguments, latLong));
  const Image image = crop(latLong, {pose, arguments.fov, size});
  print(
      writeImage(arguments.out, OutputImage{{{"", "RGB", image}}, {{"cameraFov", arguments.fov}}}));
  warnOfClipping(arguments.out, image);
}

}  // namespace

void addProbeCropCommand(Command probe) {
  auto [command, a] = probe.addCommand<ProbeCropArguments>(
      "crop", "Make the photograph that a camera in the probe's place would take.", run);
  command.addRequired("PROBE", a.probe, "the probe's image");
  command.addRequired("OUT", a.out, "the image to write: .exr, .hdr, .pfm or .png");
  command.addWithDefault("--fov", a.fov, "vertical field of view, degrees");
  command.addWithDefault("--yaw", a.pose.yaw, "degrees from -Z, positive to the left");
  command.addWithDefault("--pitch", a.pose.pitch, "degrees, positive up");
  command.addWithDefault("--roll", a.pose.roll, "degrees, positive lifts the camera's right");
  command.addOption("--size", a.size,
                    "WIDTHxHEIGHT; else 4:3, with pixels in the middle as wide as texels");
  command.addOption("--probe-mapping", a.mapping, "the mapping of PROBE; auto detects it");
  command.footer("These are the angles of a tile of `probe stitch`, which puts crops together.\n");
}

}  // namespace chromeball
