// SPDX-License-Identifier: Apache-2.0
// chromeball probe edit IN OUT
#include <algorithm>
#include <cctype>
#include <limits>
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
#include "probe/mapping.h"
#include "probe_options.h"

namespace chromeball {
namespace {

struct ProbeEditArguments {
  std::string in, out, mapping = "auto", belowHorizon, scale, clip, clipStops, fillNadir;
  std::vector<std::string> regions, gains;
  Rotation rotation;
};

struct Region {
  std::string text;
  dvec3 centre;
  double radius;  // degrees
  Rgb gain;
};

// The edits, in the order in which they are applied.
struct Edits {
  Rotation rotation;
  double nadirRadius = 0;  // degrees; 0: nothing
  bool isMirrored = false;
  std::optional<Rgb> ground;
  std::vector<Region> regions;
  std::optional<Rgb> scale;
  std::optional<double> clip, clipStops;
};

double parseNumber(const std::string& text, std::string_view option) {
  return parseNumbers(text, 1, option).front();
}

Region parseRegion(const std::string& text, const std::string& gain) {
  const std::vector<double> region = parseNumbers(text, 3, "--region");
  constexpr double kLargest = 3600;
  if (std::fabs(region[0]) > kLargest)
    throwInput("--region: the azimuth {} should be {} to {} degrees", region[0], -kLargest,
               kLargest);
  if (std::fabs(region[1]) > 90)
    throwInput("--region: the elevation {} should be -90 to 90 degrees", region[1]);
  if (!(region[2] > 0 && region[2] <= 180))
    throwInput("--region: the radius {} should be above 0, up to 180 degrees", region[2]);
  return {text, directionAt(region[0], region[1]), region[2], parseColor(gain, "--gain")};
}

void parseGround(const std::string& text, Edits& edits) {
  edits.isMirrored = text == "mirror";
  if (text == "black")
    edits.ground = Rgb(0);
  else if (!text.empty() && (std::isalpha(static_cast<unsigned char>(text[0])) == 0))
    edits.ground = parseColor(text, "--below-horizon");
  else if (!text.empty() && !edits.isMirrored)
    throwInput("--below-horizon: `{}` should be black, mirror or a radiance R,G,B", text);
}

Edits parse(const ProbeEditArguments& arguments) {
  Edits edits;
  edits.rotation = arguments.rotation;
  if (!arguments.fillNadir.empty()) {
    edits.nadirRadius = parseNumber(arguments.fillNadir, "--fill-nadir");
    if (!(edits.nadirRadius > 0 && edits.nadirRadius <= 90))
      throwInput("--fill-nadir: {} should be above 0, up to 90 degrees", edits.nadirRadius);
  }
  parseGround(arguments.belowHorizon, edits);
  if (arguments.regions.size() != arguments.gains.size())
    throwInput("--region: each needs a --gain, and each --gain a region; there are {} and {}",
               arguments.regions.size(), arguments.gains.size());
  for (size_t i = 0; i < arguments.regions.size(); ++i)
    edits.regions.push_back(parseRegion(arguments.regions[i], arguments.gains[i]));
  if (!arguments.scale.empty()) edits.scale = parseColor(arguments.scale, "--probe-scale");
  if (!arguments.clip.empty()) {
    edits.clip = parseNumber(arguments.clip, "--clip");
    if (!isPositiveFloat(*edits.clip))
      throwInput("--clip: {} should be above 0: {}", *edits.clip, kPositiveFloats);
  }
  if (!arguments.clipStops.empty())
    edits.clipStops = parseNumber(arguments.clipStops, "--clip-stops");
  const bool isEmpty = edits.rotation == Rotation() && edits.nadirRadius == 0 &&
                       !edits.isMirrored && !edits.ground && edits.regions.empty() &&
                       !edits.scale && !edits.clip && !edits.clipStops;
  if (isEmpty)
    throwInput(
        "probe edit: nothing to do; give --probe-rotation, --fill-nadir, --below-horizon, "
        "--region, "
        "--probe-scale, --clip or --clip-stops");
  return edits;
}

// The largest float if the level is above it: then nothing is clipped.
float clipLevel(const Edits& edits, const Image& latLong) {
  if (edits.clip) return float(*edits.clip);
  const double mean = luminance(meanRadiance(latLong)), level = mean * std::exp2(*edits.clipStops);
  if (mean > 0 && !(float(level) > 0))
    throwInput("--clip-stops: {} times 2^{} should be at least 1.4e-45, the least float", mean,
               *edits.clipStops);
  return float(std::min(level, double(std::numeric_limits<float>::max())));
}

void apply(const Edits& edits, const std::string& file, Image& latLong) {
  if (!(edits.rotation == Rotation()))
    latLong = convert(latLong, Mapping::LatLong, Mapping::LatLong, {latLong.width, latLong.height},
                      edits.rotation);
  if (edits.nadirRadius > 0 && fillNadir(latLong, edits.nadirRadius) == 0)
    throwInput(
        "--fill-nadir: no texel's centre is within {} degrees of straight down: the rows of {} are "
        "{:.3g} degrees high",
        edits.nadirRadius, file, 180. / latLong.height);
  if (edits.isMirrored) mirrorAtHorizon(latLong);
  if (edits.ground) replaceBelowHorizon(latLong, *edits.ground);
  for (const Region& region : edits.regions)
    if (multiplyRegion(latLong, region.centre, region.radius, region.gain) == 0)
      throwInput(
          "--region: no texel's centre is within {}: the texels of {} are {:.3g} degrees high",
          region.text, file, 180. / latLong.height);
  if (edits.scale) multiply(latLong, *edits.scale);
  if (!std::all_of(latLong.texels.begin(), latLong.texels.end(),
                   [](float channel) { return std::isfinite(channel); }))
    throwInput("{}: a texel times the gain and scale exceeds the range of a float", file);
  if (edits.clip || edits.clipStops) clip(latLong, clipLevel(edits, latLong));
}

void run(const ProbeEditArguments& arguments) {
  const Edits edits = parse(arguments);
  checkWritable(arguments.out);
  checkDistinct({arguments.out}, {arguments.in});
  LoadedProbe probe = openProbe(arguments.in, arguments.mapping, "--probe-mapping");
  apply(edits, arguments.in, probe.latLong);
  writeProbe(arguments.out, probe.latLong);
}

}  // namespace

void addProbeEditCommand(Command probe) {
  auto [command, a] = probe.addCommand<ProbeEditArguments>(
      "edit",
      "Change the light of a probe, and write it as a lat-long map. Edits are done in the order of "
      "the options below; angles are in degrees.",
      run);
  command.addRequired("IN", a.in, "the probe's image");
  command.addRequired("OUT", a.out, "the image to write: .exr, .hdr, .pfm or .png");
  addRotationOption(command, a.rotation, "; before all other edits");
  command.addOption("--fill-nadir", a.fillNadir,
                    "RADIUS: fill the disc straight below smoothly from its rim (a tripod)");
  command.addOption("--below-horizon", a.belowHorizon,
                    "replace the lower half: black, mirror (the upper half's), or radiance R,G,B");
  command
      .addOption("--region", a.regions,
                 "AZIMUTH,ELEVATION,RADIUS: a disc to multiply by --gain; may be given several "
                 "times. Azimuth is from -Z, the map's centre, counter-clockwise seen from above")
      .onePerName();
  command.addOption("--gain", a.gains, "X or R,G,B, one for each --region, in order").onePerName();
  command.addOption("--probe-scale", a.scale, "X or R,G,B: multiply all radiance");
  command.addOption("--clip", a.clip, "X: lower the channels above X to X");
  command
      .addOption("--clip-stops", a.clipStops,
                 "N: the same at 2^N times the mean luminance over the sphere")
      .excludes("--clip");
  command.addOption("--probe-mapping", a.mapping, "the mapping of IN; auto detects it");
}

}  // namespace chromeball
