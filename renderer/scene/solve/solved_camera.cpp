// SPDX-License-Identifier: Apache-2.0
#include "scene/solve/solved_camera.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/camera_view.h"

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

Message warning(std::string text) { return {Message::Kind::Warning, std::move(text)}; }

// By what factor the RMS of another camera must be larger, so that noise does not explain it. Of
// few degrees of freedom n, the best camera may fit by chance: sqrt(F(n, n)) at 95% is 4.4 for
// 2, 3.0 for 3, 2.2 for 5.
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
    messages.push_back(warning(fmt::format(
        "no camera fits: the distances are {:.3g} pixels in the root mean square; check the "
        "positions, and that pixels count from the top left",
        rms)));
  else if (fit.rivalRms && *fit.rivalRms < leastRatio(fit) * rms)
    messages.push_back(warning(fmt::format(
        "another camera fits nearly as well, with {:.3g} instead of {:.3g} pixels; more points, "
        "not on one plane, tell which is right",
        *fit.rivalRms, rms)));
  if (fit.errors.fov && *fit.errors.fov > kUncertain * fit.camera.fov())
    messages.push_back(
        warning("the field of view is uncertain by more than a tenth; give it if it is known"));
  return messages;
}

Messages doubtsAbout(const std::vector<ObservedPoint>& points, const ImageSize& size) {
  Messages messages;
  for (const ObservedPoint& point : points) {
    const dvec2& p = point.pixel;
    if (!(p.x >= 0 && p.y >= 0 && p.x <= size.width && p.y <= size.height))
      messages.push_back(warning(fmt::format("{}: `{}` is outside the picture of {}x{} pixels",
                                             point.location, point.name, size.width, size.height)));
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
    return {warning("the camera does not see the model, which lies outside the picture")};
  return {};
}

}  // namespace chromeball
