// SPDX-License-Identifier: Apache-2.0
#include "assemble_options.h"
#include "input_image.h"

#include "base/error.h"
#include "base/file.h"
#include "front/arguments.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "messages.h"
#include "probe/capture/photograph.h"
#include "probe/convert.h"
#include "probe/load.h"
#include "write_probe.h"

namespace chromeball {
namespace {

void addBallOptions(Command command, AssembleArguments& arguments) {
  command.addOption("--distance", arguments.distance,
                    "from the ball's centre to the camera, in radii of the ball; else infinite");
  command.addOption("--reflectivity", arguments.reflectivity,
                    "X or R,G,B of the ball, as `probe reflectivity` measures it; else 1");
  command
      .addOption(
          "--ball-ior", arguments.ballIor,
          "N,K: the reflectivity changes with the angle as that of a metal of refractive index N + "
          "iK: chrome 3.18,3.31. Without --reflectivity, also its value at the centre")
      .excludes(command.addFlag("--schlick", arguments.schlick,
                                "the reflectivity rises to 1 at the rim, by Schlick's "
                                "approximation: a rendered ball of glTF"));
  command.addOption(
      "--camera-disc", arguments.cameraDisc,
      "degrees around the camera's reflection that other photographs replace; else 15");
}

// "X", for all channels, or "R,G,B".
dvec3 parseReflectivity(const std::string& text) {
  const bool isOne = text.find(',') == std::string::npos;
  const std::vector<double> c = parseNumbers(text, isOne ? 1 : 3, "--reflectivity");
  for (const double channel : c)
    if (!(channel >= 1e-3 && channel <= 1))
      throwInput("--reflectivity: {} should be 0.001 to 1", channel);
  return isOne ? dvec3(c[0]) : dvec3(c[0], c[1], c[2]);
}

BallReflectance parseReflectance(const AssembleArguments& arguments) {
  std::optional<dvec3> normal;
  if (!arguments.reflectivity.empty()) normal = parseReflectivity(arguments.reflectivity);
  if (arguments.schlick && !normal)
    throwInput("--schlick: needs --reflectivity, that at the centre of the ball");
  if (arguments.schlick) return BallReflectance::schlick(*normal);
  if (arguments.ballIor.empty()) return BallReflectance(normal.value_or(dvec3(1)));
  const std::vector<double> index = parseNumbers(arguments.ballIor, 2, "--ball-ior");
  const MetalIndex metal{index[0], index[1]};
  const double atCentre = metalFresnel(1, metal);
  if (!(metal.n >= 0.01 && metal.n <= 100 && metal.k >= 0 && metal.k <= 100 && atCentre > 1e-3))
    throwInput(
        "--ball-ior: {} should be N,K of a metal, such as 3.18,3.31 for chrome: N from 0.01, and "
        "both up to 100",
        arguments.ballIor);
  return BallReflectance::ofMetal(normal.value_or(dvec3(atCentre)), metal);
}

// A number within [least, most], or `fallback` for no text.
double parseRange(const std::string& text, double fallback, double least, double most,
                  std::string_view option, std::string_view meaning) {
  if (text.empty()) return fallback;
  const double number = parseNumbers(text, 1, option)[0];
  if (!(number >= least && number <= most))
    throwInput("{}: {} should be {} to {}: {}", option, number, least, most, meaning);
  return number;
}

bool isColor(const std::string& text) {
  return std::count(text.begin(), text.end(), ',') == 2 &&
         text.find_first_not_of("0123456789.,eE+-") == std::string::npos;
}

}  // namespace

void addAssembleOptions(Command command, AssembleArguments& arguments) {
  command.addRequired("PHOTO", arguments.photographs, "linear images, up to 16");
  command.addRequired("-o,--output", arguments.out, "the image to write: .exr, .hdr, .pfm or .png");
  command
      .addOption("--azimuth", arguments.azimuths,
                 "AZIMUTH[:ELEVATION],...: where each camera is, in degrees, seen from the ball: 0 "
                 "is +Z, 90 is +X. A lens looks away from there: 0 towards -Z, 90 towards -X, "
                 "0:-90 straight up. One photograph: 0 if left out")
      .onePerName();
  command
      .addOption("--circle", arguments.circles,
                 "X,Y,RADIUS[;...]: the outline of each ball, in pixels from the top left corner; "
                 "else, or for auto, it is found; a fisheye's square picture without one is filled "
                 "by its circle")
      .onePerName();
  command
      .addOption("--mask", arguments.masks,
                 "an image of the same size, black where a photograph shows the stand or the "
                 "operator; one for all, or one for each")
      .onePerName();
  addBallOptions(command, arguments);
  command.addOption("--from", arguments.from,
                    "mirror-ball, or fisheye[:FOV[:PROJECTION]]: 180 degrees; equidistant, "
                    "equisolid, orthographic or stereographic");
  command.addFlag("--keep-exposure", arguments.keepExposure,
                  "do not match the exposures of the photographs");
  command.addFlag("--keep-azimuth", arguments.keepAzimuth,
                  "do not correct the azimuths by up to 5 degrees");
  command.addOption(
      "--fill", arguments.fill,
      "what blind directions get: inpaint (smooth), black, R,G,B or the file of a probe");
  command.addOption("--to", arguments.to, "the mapping of the output, as of `probe convert`");
  command.addOption("--size", arguments.size, "WIDTHxHEIGHT; else the size that keeps the detail");
  command.addOption("--preview", arguments.preview,
                    "a .png: the circles on the photographs, and the probe with its blind spots");
  command.addFlag("--json", arguments.json, "print JSON");
}

void checkFiles(const AssembleArguments& arguments) {
  constexpr size_t kMostPhotographs = 16;
  if (arguments.photographs.size() > kMostPhotographs)
    throwInput("probe assemble: {} photographs are too many; at most {}",
               arguments.photographs.size(), kMostPhotographs);
  checkWritable(arguments.out);
  if (!arguments.preview.empty()) checkOutputFile(arguments.preview, {".png"});
  std::vector<std::string> inputs = arguments.photographs;
  inputs.insert(inputs.end(), arguments.masks.begin(), arguments.masks.end());
  inputs.push_back(arguments.fill);
  checkDistinct({arguments.out, arguments.preview}, inputs);
}

std::shared_ptr<const CaptureOptics> parseOptics(const AssembleArguments& arguments) {
  if (!arguments.isFisheye()) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const double distance = parseRange(arguments.distance, kInfinity, 1.1, 1e9, "--distance",
                                       "radii of the ball, from its centre");
    const double cameraDisc =
        parseRange(arguments.cameraDisc, 15, 0, 90, "--camera-disc", "degrees");
    return std::make_shared<BallOptics>(distance, parseReflectance(arguments), cameraDisc);
  }
  if (!namesFisheye(arguments.from))
    throwInput("--from: `{}` should be mirror-ball or fisheye[:FOV[:PROJECTION]]", arguments.from);
  const Fisheye lens = parseFisheye(arguments.from, "--from");
  const std::pair<const char*, bool> ofBalls[] = {
      {"--distance", !arguments.distance.empty()},
      {"--reflectivity", !arguments.reflectivity.empty()},
      {"--ball-ior", !arguments.ballIor.empty()},
      {"--schlick", arguments.schlick},
      {"--camera-disc", !arguments.cameraDisc.empty()}};
  for (const auto& [option, isGiven] : ofBalls)
    if (isGiven) throwInput("{}: is for mirror balls, not for a fisheye lens", option);
  return std::make_shared<FisheyeOptics>(lens);
}

BlindFill parseFill(const std::string& text) {
  if (text == "inpaint") return {.isSmooth = true, .map = {}};
  if (text == "black") return {.map = {}};
  if (isColor(text)) {
    const std::vector<double> c = parseNumbers(text, 3, "--fill");
    for (const double channel : c)
      if (!(channel >= 0 && channel <= double(std::numeric_limits<float>::max())))
        throwInput("--fill: {} should be a radiance, 0 to 3.4e38", channel);
    return {.color = Rgb(dvec3(c[0], c[1], c[2])), .map = {}};
  }
  std::error_code ignored;
  if (!std::filesystem::exists(text, ignored))
    throwInput("--fill: `{}` should be inpaint, black, R,G,B or the file of a probe", text);
  return {.map = openProbe(text, "auto", "--fill").latLong};
}

AssemblyTarget parseTarget(const AssembleArguments& arguments,
                           const std::vector<CaptureView>& views) {
  const ImageSize natural = assemblySize(views);
  if (arguments.size.empty()) {
    const Mapping mapping = parseMapping(arguments.to, "--to");
    return {mapping, sizeFor(mapping, natural), natural};
  }
  const ImageSize size = checkedSize(arguments.out, parseSize(arguments.size, "--size"));
  const std::optional<Mapping> mapping =
      parseMapping(arguments.to, size.width, size.height, "--to");
  if (!mapping) return {parseMapping(arguments.to, "--to"), size, size};
  return {*mapping, size, *mapping == Mapping::LatLong ? size : natural};
}

}  // namespace chromeball
