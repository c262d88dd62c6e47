// SPDX-License-Identifier: Apache-2.0
// chromeball probe stitch TILES.toml -o OUT
#include <filesystem>
#include <optional>

#include "base/error.h"
#include "base/text.h"
#include "commands.h"
#include "front/arguments.h"
#include "front/tile_file.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "image_files.h"
#include "messages.h"
#include "probe/capture/stitch.h"
#include "progress_bar.h"

namespace chromeball {
namespace {

struct ProbeStitchArguments {
  std::string list, out, poses, size;
  bool refine = false, sameExposure = false;
};

std::vector<Tile> loadTiles(const std::vector<TileEntry>& entries) {
  std::vector<Tile> tiles;
  for (const TileEntry& entry : entries) {
    ImageFile file = openImageFile(entry.file);
    print(clippedLight(file, entry.file));
    tiles.push_back({entry.file, colorOf(std::move(file), entry.file),
                     Rotation::ofAngles(entry.pose), entry.fov});
    for (const float channel : tiles.back().image.texels)
      if (!std::isfinite(channel)) throwInput("{}: has invalid pixels", entry.file);
  }
  return tiles;
}

// Fills in the refined poses.
void refine(std::vector<TileEntry>& entries, std::vector<Tile>& tiles) {
  std::optional<BusyLine> busy("refining poses");
  const PoseRefinement refinement = refinePoses(tiles);
  busy.reset();
  for (size_t i = 0; i < tiles.size(); ++i) {
    entries[i].pose = tiles[i].pose.angles();
    const Rotation::Angles& pose = entries[i].pose;
    say("{}  yaw {:.4f}, pitch {:.4f}, roll {:.4f}: turned by {:.4f} degrees\n",
        printable(entries[i].file), pose.yaw, pose.pitch, pose.roll, refinement.turns[i]);
  }
  if (tiles.size() < 2) return;  // nothing overlaps
  say("overlaps differ by {:.3g}% before and {:.3g}% after, RMS of the log radiance\n",
      100 * refinement.before, 100 * refinement.after);
}

std::vector<double> gainsOf(const ProbeStitchArguments& arguments, const std::vector<Tile>& tiles) {
  if (arguments.sameExposure) return std::vector<double>(tiles.size(), 1.0);
  const std::vector<double> gains = [&] {
    try {
      return tileGains(tiles);
    } catch (const InputError& error) {
      throwInput("{}; if all have the same exposure, give --same-exposure", error.what());
    }
  }();
  for (size_t i = 0; i < tiles.size(); ++i)
    say("{}  gain {:.4f}\n", printable(tiles[i].name), gains[i]);
  return gains;
}

void run(const ProbeStitchArguments& arguments) {
  checkWritable(arguments.out);
  if (!arguments.poses.empty()) checkOutputFile(arguments.poses, {".toml"});
  if (!arguments.poses.empty() && !arguments.refine)
    throwInput("--poses: are those that --refine finds");
  ImageSize size{};
  if (!arguments.size.empty())
    size = checkedSize(arguments.out, parseSize(arguments.size, "--size"));
  std::vector<TileEntry> entries = readTiles(arguments.list);
  std::vector<std::string> inputs{arguments.list};
  for (const TileEntry& entry : entries) inputs.push_back(entry.file);
  std::vector<std::string> outputs{arguments.out};
  if (!arguments.poses.empty()) outputs.push_back(arguments.poses);
  checkDistinct(outputs, inputs);
  std::vector<Tile> tiles = loadTiles(entries);
  if (arguments.refine) refine(entries, tiles);
  const std::vector<double> gains = gainsOf(arguments, tiles);
  std::optional<BusyLine> busy("stitching");
  if (arguments.size.empty()) size = checkedSize(arguments.out, stitchedSize(tiles));
  const StitchedProbe probe = stitch(tiles, gains, size);
  busy.reset();
  constexpr double kGap = 1e-5;
  if (probe.uncovered > kGap)
    warn("{:.3g}% of the sphere is in no tile, and black", 100 * probe.uncovered);
  writeProbe(arguments.out, probe.latLong);
  if (!arguments.poses.empty()) writeTiles(arguments.poses, entries);
}

}  // namespace

void addProbeStitchCommand(Command probe) {
  auto [command, a] = probe.addCommand<ProbeStitchArguments>(
      "stitch", "Stitch photographs of known direction (tiles) to a lat-long probe.", run);
  command.addRequired("TILES", a.list, "the list of tiles (.toml); see below");
  command.addRequired("-o,--output", a.out, "the probe to write: .exr, .hdr, .pfm or .png");
  command.addOption("--size", a.size,
                    "WIDTHxHEIGHT; else the size that keeps the detail of the tiles");
  command.addFlag("--refine", a.refine,
                  "turn all tiles but the first until they agree where they overlap");
  command.addOption("--poses", a.poses,
                    "with --refine: write the list with the poses that were found (.toml), for "
                    "other exposures from the same directions");
  command.addFlag("--same-exposure", a.sameExposure,
                  "take the tiles as they are; else factors make them agree where they overlap");
  command.footer(
      "The list:\n  fov = 50            # vertical, degrees; of all tiles that give none\n  "
      "[[tile]]\n  file = \"a.exr\"      # linear, relative to the list\n  yaw = 40            # "
      "of the camera, as of a probe's rotation: 0 looks along -Z,\n  pitch = 10          # "
      "positive yaw to the left, positive pitch up,\n  roll = 0            # positive roll lifts "
      "the camera's right\n");
}

}  // namespace chromeball
