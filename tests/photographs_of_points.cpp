// SPDX-License-Identifier: Apache-2.0
#include "photographs_of_points.h"

#include <fmt/format.h>

namespace chromeball {

SolvedCamera photographFrom(const dvec3& position, const dvec3& target, double fovDegrees,
                            double k1, const ImageSize& size) {
  SolvedCamera camera;
  camera.size = size;
  camera.position = position;
  camera.axes[2] = glm::normalize(position - target);
  camera.axes[0] = glm::normalize(glm::cross(dvec3(0.1, 1, 0), camera.axes[2]));
  camera.axes[1] = glm::cross(camera.axes[2], camera.axes[0]);
  camera.focalLength = 0.5 * size.height / std::tan(fovDegrees * kPiD / 360);
  camera.distortion.k1 = k1;
  return camera;
}

std::optional<dvec2> pixelOf(const SolvedCamera& camera, const dvec3& point) {
  const dvec3 to = point - camera.position;
  const double depth = -glm::dot(to, camera.axes[2]);
  if (!(depth > 0.05)) return std::nullopt;
  const double x = glm::dot(to, camera.axes[0]) / depth, y = glm::dot(to, camera.axes[1]) / depth;
  const double r2 = x * x + y * y;
  if (1 + 3 * camera.distortion.k1 * r2 <= 0) return std::nullopt;
  const double scale = camera.focalLength * (1 + camera.distortion.k1 * r2);
  const dvec2 pixel(camera.principalPoint.x * camera.size.width + scale * x,
                    camera.principalPoint.y * camera.size.height - scale * y);
  const bool isInside =
      pixel.x >= 0 && pixel.y >= 0 && pixel.x <= camera.size.width && pixel.y <= camera.size.height;
  return isInside ? std::optional(pixel) : std::nullopt;
}

std::vector<ObservedPoint> observe(const SolvedCamera& camera, size_t count, const dvec3& half,
                                   double noise, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::normal_distribution<double> normal;
  std::vector<ObservedPoint> points;
  while (points.size() < count) {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    const dvec3 position = half * dvec3(x, y, z);
    const auto pixel = pixelOf(camera, position);
    if (!pixel) continue;
    const double right = noise * normal(random), down = noise * normal(random);
    const std::string name = fmt::format("p{}", points.size());
    points.push_back({name, "points.csv:1", position, *pixel + dvec2(right, down)});
  }
  return points;
}

dvec3 turnBetween(const glm::dmat3& a, const glm::dmat3& b) {
  const glm::dmat3 turn = glm::transpose(a) * b;
  return 0.5 * dvec3(turn[1][2] - turn[2][1], turn[2][0] - turn[0][2], turn[0][1] - turn[1][0]);
}

}  // namespace chromeball
