// SPDX-License-Identifier: Apache-2.0
#include "assemble_options.h"
#include "base/error.h"
#include "front/arguments.h"
#include "messages.h"
#include "probe/capture/find_circle.h"
#include "probe/capture/photograph.h"

namespace chromeball {
namespace {

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
    const std::optional<Circle> filling = isFisheye ? circleOfSquare(image) : std::nullopt;
    if (!found && filling) {
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
