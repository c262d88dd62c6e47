// SPDX-License-Identifier: Apache-2.0
#include "scene/solve/solve_camera.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/file.h"
#include "base/json.h"

namespace chromeball {
namespace {

constexpr double kFilmDiagonal = 43.266615305567875;  // of 36 x 24 mm

double diagonal(const ImageSize& size) { return std::hypot(size.width, size.height); }

}  // namespace

double SolvedCamera::fov() const { return 2 * std::atan(0.5 * size.height / focalLength); }

Camera SolvedCamera::camera() const {
  Camera camera;
  camera.position = vec3(position);
  camera.right = vec3(axes[0]), camera.up = vec3(axes[1]), camera.back = vec3(axes[2]);
  camera.fov = float(fov());
  camera.principalPoint = vec2(principalPoint);
  camera.distortion = distortion;
  return camera;
}

dvec3 SolvedCamera::directionAt(const dvec2& pixel) const {
  const dvec2 axis = principalPoint * dvec2(size.width, size.height);
  dvec2 seen = (pixel - axis) / focalLength;
  if (const double radius = glm::length(seen); distortion && radius > 0)
    seen *= distortion.undistorted(radius) / radius;
  return axes * glm::normalize(dvec3(seen.x, -seen.y, -1));
}

double CameraFit::rms() const {
  double sum = 0;
  for (const double distance : distances) sum += distance * distance;
  return std::sqrt(sum / double(distances.size()));
}

size_t CameraFit::worst() const {
  return size_t(std::max_element(distances.begin(), distances.end()) - distances.begin());
}

double focalLengthOfFov(const ImageSize& size, double fov) {
  return 0.5 * size.height / std::tan(0.5 * fov);
}

double focalLengthOf35mm(const ImageSize& size, double millimetres) {
  return millimetres * diagonal(size) / kFilmDiagonal;
}

double equivalentOn35mm(const ImageSize& size, double focalLength) {
  return focalLength * kFilmDiagonal / diagonal(size);
}

namespace {

// The factor by which the RMS of another camera must be larger if noise is not to explain it. With
// few degrees of freedom n, the best camera may fit by chance: sqrt(F(n, n)) at 95% is 4.4 for 2,
// 3.0 for 3, 2.2 for 5.
double leastRatio(const CameraFit& fit) {
  constexpr double kManyPoints = 2;
  const int unknowns = 6 + fit.errors.fov.has_value() + fit.errors.k1.has_value();
  const int freedom = std::max(1, int(2 * fit.distances.size()) - unknowns);
  return std::max(kManyPoints, 1.3 + 6.2 / freedom);
}

}  // namespace

Messages doubtsAbout(const CameraFit& fit) {
  constexpr double kMisfit = 0.01;  // of the picture's diagonal
  constexpr double kUncertain = 0.1;
  Messages messages;
  const ImageSize& size = fit.camera.size;
  const double rms = fit.rms();
  if (rms > kMisfit * std::hypot(size.width, size.height))
    addWarning(messages,
               "no camera fits: the distances are {:.3g} pixels in the root mean square; check the "
               "positions, and that pixels count from the top left",
               rms);
  else if (fit.rivalRms && *fit.rivalRms < leastRatio(fit) * rms)
    addWarning(messages,
               "another camera fits nearly as well, with {:.3g} instead of {:.3g} pixels; more "
               "points, not on one plane, tell which is right",
               *fit.rivalRms, rms);
  if (fit.errors.fov && *fit.errors.fov > kUncertain * fit.camera.fov())
    addWarning(messages,
               "the field of view is uncertain by more than a tenth; give it if it is known");
  return messages;
}

Messages doubtsAbout(const std::vector<ObservedPoint>& points, const ImageSize& size) {
  Messages messages;
  for (const ObservedPoint& point : points) {
    const dvec2& p = point.pixel;
    if (!(p.x >= 0 && p.y >= 0 && p.x <= size.width && p.y <= size.height))
      addWarning(messages, "{}: `{}` is outside the picture of {}x{} pixels", point.location,
                 point.name, size.width, size.height);
  }
  return messages;
}

Messages doubtsAbout(const SolvedCamera& camera, const Bounds& model) {
  if (model.empty()) return {};
  const CameraView view(camera.camera(), double(camera.size.width) / camera.size.height);
  dvec2 min(INFINITY), max(-INFINITY);
  int behind = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const auto seen =
        view.at({(corner & 1 ? model.max : model.min).x, (corner & 2 ? model.max : model.min).y,
                 (corner & 4 ? model.max : model.min).z});
    if (!seen) {
      ++behind;
      continue;
    }
    min = glm::min(min, seen->position);
    max = glm::max(max, seen->position);
  }
  const bool isBeside = max.x < 0 || max.y < 0 || min.x > 1 || min.y > 1;
  if (behind == 8 || (behind == 0 && isBeside))
    return {makeWarning("the camera does not see the model, which lies outside the picture")};
  return {};
}

namespace {

using Json = nlohmann::json;

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : path_(path.string()) {
    constexpr size_t kMaxBytes = 1 << 20;
    checkReadable(path);
    if (std::filesystem::file_size(path) > kMaxBytes)
      throwInput("{}: is too long for the camera parameters of fSpy", path_);
    const std::vector<uint8_t> bytes = readFile(path);
    root_ = readJson({bytes.begin(), bytes.end()});
    if (!root_.is_object())
      throwInput(
          "{}: is not JSON with the camera parameters of fSpy; a project (.fspy) is not: export "
          "them",
          path_);
  }

  // The number at a path such as "/principalPoint/x", between `least` and `most`.
  double number(const std::string& pointer, double least = -kLargestCoordinate,
                double most = kLargestCoordinate) const {
    const Json::json_pointer at(pointer);
    const double value =
        root_.contains(at) && root_[at].is_number() ? root_[at].get<double>() : NAN;
    if (!(value > least && value < most))
      fail(pointer, fmt::format("a number between {:g} and {:g}", least, most));
    return value;
  }

  [[noreturn]] void fail(const std::string& pointer, const std::string& wanted) const {
    throwInput("{}: `{}` should be {}", path_, pointer.substr(1), wanted);
  }

 private:
  std::string path_;
  Json root_;
};

dvec3 turnedUp(const dvec3& v) { return {v.x, v.z, -v.y}; }

}  // namespace

SolvedCamera readFspy(const std::filesystem::path& path, bool zUp) {
  constexpr double kTolerance = 1e-3, kMostPixels = 1e6;
  const Reader file(path);
  SolvedCamera camera;
  camera.size = {int(file.number("/imageWidth", 0, kMostPixels)),
                 int(file.number("/imageHeight", 0, kMostPixels))};
  if (camera.size.width < 1 || camera.size.height < 1) file.fail("/imageWidth", "1 or more");
  const double fov = file.number("/verticalFieldOfView", 0, kPiD);
  camera.focalLength = focalLengthOfFov(camera.size, fov);
  for (int row = 0; row < 3; ++row) {
    const auto at = [&](int column) {
      return file.number(fmt::format("/cameraTransform/rows/{}/{}", row, column));
    };
    for (int column = 0; column < 3; ++column) camera.axes[column][row] = at(column);
    camera.position[row] = at(3);
  }
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(glm::dot(camera.axes[i], camera.axes[k]) - (i == k)) < kTolerance))
        file.fail("/cameraTransform", "a rotation and a translation");
  if (!(glm::determinant(camera.axes) > 0)) file.fail("/cameraTransform", "no reflection");
  camera.axes[0] = glm::normalize(camera.axes[0]);
  camera.axes[2] = glm::normalize(glm::cross(camera.axes[0], camera.axes[1]));
  camera.axes[1] = glm::cross(camera.axes[2], camera.axes[0]);
  const double longer = std::max(camera.size.width, camera.size.height);
  camera.principalPoint.x =
      0.5 + 0.5 * longer / camera.size.width * file.number("/principalPoint/x");
  camera.principalPoint.y =
      0.5 - 0.5 * longer / camera.size.height * file.number("/principalPoint/y");
  if (zUp) {
    camera.position = turnedUp(camera.position);
    for (int i = 0; i < 3; ++i) camera.axes[i] = turnedUp(camera.axes[i]);
  }
  camera.distance = glm::length(camera.position);
  return camera;
}

}  // namespace chromeball
