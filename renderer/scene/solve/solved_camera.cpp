// SPDX-License-Identifier: Apache-2.0
#include "scene/solve/solved_camera.h"

#include <algorithm>

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

}  // namespace chromeball
