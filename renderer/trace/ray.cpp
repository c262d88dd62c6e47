// SPDX-License-Identifier: Apache-2.0
#include "trace/ray.h"

#include <array>
#include <limits>

#include "scene/surface.h"

namespace chromeball {

std::optional<Ray> turnedOffEdges(const Scene& scene, const Ray& ray, const Hit& hit) {
  const Instance& instance = scene.instances[hit.instance];
  const Triangle& triangle = scene.meshes[instance.mesh].triangles[hit.triangle];
  // Relative to the origin, projected perpendicular to the ray.
  std::array<vec3, 3> corners = cornersAt(scene, instance, triangle, ray.time);
  for (vec3& corner : corners) {
    const vec3 away = corner - ray.origin;
    corner = away - glm::dot(away, ray.direction) * ray.direction;
  }
  const vec2& b = hit.barycentric;
  const std::array weights{1 - b.x - b.y, b.x, b.y};

  // Bound on the rounding error of a hit point, origin + distance * direction.
  const vec3 origin = absolute(ray.origin);
  const float rounding =
      2 * std::numeric_limits<float>::epsilon() * (origin.x + origin.y + origin.z + hit.distance);
  const float move = 8 * rounding;
  if (move > 1e-3f * hit.distance) return std::nullopt;

  float nearest = 4 * rounding;
  vec3 inwards(0);  // unit, away from the nearest edge
  for (int i = 0; i < 3; ++i) {
    const vec3& start = corners[(i + 1) % 3];
    const vec3 edge = corners[(i + 2) % 3] - start, side = corners[i] - start;
    const vec3 height = side - edge * (glm::dot(side, edge) / glm::dot(edge, edge));
    const float length = glm::length(height);
    if (length > 0 && weights[i] * length < nearest) {
      nearest = weights[i] * length;
      inwards = height / length;
    }
  }
  if (inwards == vec3(0)) return std::nullopt;
  const vec3 target = hit.distance * ray.direction + move * inwards;
  return Ray{ray.origin, glm::normalize(target), ray.tMax, ray.time};
}

}  // namespace chromeball
