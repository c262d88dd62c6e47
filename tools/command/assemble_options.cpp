// SPDX-License-Identifier: Apache-2.0
#include "assemble_options.h"

#include "base/error.h"
#include "base/file.h"
#include "front/arguments.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "image_files.h"
#include "messages.h"
#include "probe/capture/find_circle.h"
#include "probe/capture/photograph.h"
#include "probe/convert.h"
#include "probe/load.h"

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

std::vector<std::string> split(const std::vector<std::string>& texts, char separator) {
  std::vector<std::string> parts;
  for (const std::string& text : texts)
    for (size_t begin = 0; begin <= text.size();) {
      const size_t end = std::min(text.find(separator, begin), text.size());
      parts.push_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
  return parts;
}

void checkCount(const std::vector<std::string>& values, size_t photographs,
                std::string_view option) {
  if (values.size() != photographs)
    throwInput("{}: {} given for {} photograph{}; give one for each, in order", option,
               values.size(), photographs, photographs == 1 ? "" : "s");
}

// "AZIMUTH" or "AZIMUTH:ELEVATION".
CameraPosition parseCamera(const std::string& text) {
  constexpr double kLargest = 3600;
  const size_t colon = std::min(text.find(':'), text.size());
  CameraPosition camera{parseNumbers(text.substr(0, colon), 1, "--azimuth")[0], 0};
  if (colon < text.size())
    camera.elevation = parseNumbers(text.substr(colon + 1), 1, "--azimuth")[0];
  if (std::fabs(camera.azimuth) > kLargest)
    throwInput("--azimuth: {} should be {} to {} degrees", camera.azimuth, -kLargest, kLargest);
  if (std::fabs(camera.elevation) > 90)
    throwInput("--azimuth: the elevation {} should be -90 to 90 degrees", camera.elevation);
  return camera;
}

std::vector<CameraPosition> parseCameras(const AssembleArguments& arguments) {
  const std::vector<std::string> texts = split(arguments.azimuths, ',');
  if (texts.empty() && arguments.photographs.size() == 1) return {CameraPosition{}};
  if (texts.empty())
    throwInput("--azimuth: {} photographs need the azimuths of their cameras, such as 0,90",
               arguments.photographs.size());
  checkCount(texts, arguments.photographs.size(), "--azimuth");
  std::vector<CameraPosition> cameras;
  for (const std::string& text : texts) cameras.push_back(parseCamera(text));
  return cameras;
}

// Balls may be cropped by the picture (HDRI book, figure 9.9).
Circle parseCircle(const std::string& text, const Image& image, const std::string& file) {
  constexpr double kLeastRadius = 4, kLargestRadius = 65536, kLeastInside = 0.75;
  const std::vector<double> c = parseNumbers(text, 3, "--circle");
  const Circle circle{{c[0], c[1]}, c[2]};
  if (!(circle.radius >= kLeastRadius && circle.radius <= kLargestRadius))
    throwInput("--circle: the radius {} should be {} to {} pixels", circle.radius, kLeastRadius,
               kLargestRadius);
  if (shareInside(circle, image.width, image.height) < kLeastInside)
    throwInput("--circle: more than a quarter of {} is outside {}, which has {} x {} pixels", text,
               file, image.width, image.height);
  return circle;
}

// An image circle that fills the picture leaves no outline to find in it.
std::optional<Circle> circleOfSquare(const Image& image) {
  if (image.width != image.height) return std::nullopt;
  return Circle{dvec2(0.5 * image.width), 0.5 * image.width};
}

// Whether the picture has been cut to the circle that was found: nothing is around it. Programs
// write such pictures, and light the pixels that the circle cuts as a whole.
bool isCutTo(const Circle& circle, const Circle& found, const Image& image) {
  constexpr double kNear = 1.5;  // pixels
  const dvec2 apart = glm::abs(found.centre - circle.centre);
  if (std::max({apart.x, apart.y, std::fabs(found.radius - circle.radius)}) > kNear) return false;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (glm::length(dvec2(x + 0.5, y + 0.5) - circle.centre) > circle.radius + kNear &&
          !isBlack(image.rgb(x, y)))
        return false;
  return true;
}

// A circle within a fisheye's picture may also be the outline of a lamp.
bool mayBeImageCircle(const Circle& circle, const Image& image) {
  return circle.radius > 0.25 * std::min(image.width, image.height);
}

void setCircle(const std::string& given, bool isFisheye, AssemblyPhotograph& photograph) {
  const Image& image = photograph.image;
  if (given != "auto") {
    photograph.circle = parseCircle(given, image, photograph.file);
  } else {
    std::optional<FoundCircle> found = findCircle(image);
    if (isFisheye && found && !mayBeImageCircle(found->circle, image)) found.reset();
    const std::optional<Circle> filling = circleOfSquare(image);
    if (filling && (found ? isCutTo(*filling, found->circle, image) : isFisheye)) {
      photograph.circle = *filling;
      return;
    }
    if (!found)
      throwInput("{}: no {} found; give its circle in pixels: --circle X,Y,RADIUS", photograph.file,
                 isFisheye ? "image circle" : "ball");
    photograph.circle = found->circle;
    photograph.found = found;
  }
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
                 "by its circle, and a square picture that is black around that is cut to it")
      .onePerName();
  command
      .addOption("--mask", arguments.masks,
                 "an image of the same size, black where a photograph shows the stand or the "
                 "operator; one for all, or one for each")
      .onePerName();
  addBallOptions(command, arguments);
  command.addOption("--probe-mapping", arguments.from,
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

std::shared_ptr<const CaptureOptics> parseOptics(const AssembleArguments& arguments,
                                                 const Command& command) {
  if (!arguments.isFisheye()) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const double distance = parseRange(arguments.distance, kInfinity, 1.1, 1e9, "--distance",
                                       "radii of the ball, from its centre");
    const double cameraDisc =
        parseRange(arguments.cameraDisc, 15, 0, 90, "--camera-disc", "degrees");
    return std::make_shared<BallOptics>(distance, parseReflectance(arguments), cameraDisc);
  }
  if (!namesFisheye(arguments.from))
    throwInput("--probe-mapping: `{}` should be mirror-ball or fisheye[:FOV[:PROJECTION]]",
               arguments.from);
  const Fisheye lens = parseFisheye(arguments.from, "--probe-mapping");
  command.refuse({"--distance", "--reflectivity", "--ball-ior", "--schlick", "--camera-disc"},
                 "is for mirror balls, not for a fisheye lens");
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
    return {mapping, checkedSize(arguments.out, sizeFor(mapping, natural)), natural};
  }
  const ImageSize size = checkedSize(arguments.out, parseSize(arguments.size, "--size"));
  const std::optional<Mapping> mapping =
      parseMapping(arguments.to, size.width, size.height, "--to");
  if (!mapping) return {parseMapping(arguments.to, "--to"), size, size};
  return {*mapping, size,
          *mapping == Mapping::LatLong ? size : checkedSize(arguments.out, natural)};
}

std::vector<AssemblyPhotograph> loadPhotographs(const AssembleArguments& arguments) {
  const size_t count = arguments.photographs.size();
  const std::vector<CameraPosition> cameras = parseCameras(arguments);
  std::vector<std::string> circles = split(arguments.circles, ';');
  if (circles.empty()) circles.assign(count, "auto");
  checkCount(circles, count, "--circle");
  std::vector<std::string> masks = arguments.masks;
  if (masks.size() == 1) masks.assign(count, std::string(masks.front()));
  if (!masks.empty()) checkCount(masks, count, "--mask");

  std::vector<AssemblyPhotograph> photographs(count);
  for (size_t i = 0; i < count; ++i) {
    AssemblyPhotograph& photograph = photographs[i];
    photograph.file = arguments.photographs[i];
    photograph.camera = cameras[i];
    LoadedPhotograph loaded = loadPhotograph(photograph.file);
    photograph.image = std::move(loaded.image);
    if (!masks.empty())
      photograph.mask = loadMask(masks[i], photograph.image, photograph.file, loaded.messages);
    print(loaded.messages);
    setCircle(circles[i], arguments.isFisheye(), photograph);
  }
  return photographs;
}

}  // namespace chromeball
