// SPDX-License-Identifier: Apache-2.0
#include "scene/eye_view.h"

#include <algorithm>

#include "math/icosphere.h"
#include "scene/placed_triangles.h"

namespace chromeball {
namespace {

using glm::dvec3;

// Sights ordered by height, so that a triangle meets those of a short range only.
class EyeView {
 public:
  explicit EyeView(const dvec3& eye) : eye_(eye) {
    constexpr int kSubdivisions = 2;
    for (const vec3& direction : icosphereNormals(kSubdivisions))
      sights_.push_back({.direction = glm::normalize(dvec3(direction))});
    std::ranges::sort(sights_, {}, [](const Sight& s) { return s.direction.y; });
  }

  void add(const Corners& corners, bool isDoubleSided) {
    const dvec3 a = corners[0] - eye_, b = corners[1] - eye_, c = corners[2] - eye_;
    const dvec3 bc = glm::cross(b, c), ca = glm::cross(c, a), ab = glm::cross(a, b);
    const dvec3 normal = bc + ca + ab;
    const double volume = glm::dot(a, bc);
    if (!(glm::dot(normal, normal) > 0)) return;
    const auto [low, high] = heights(a, b, c);
    const auto height = [](const Sight& s) { return s.direction.y; };
    for (auto s = std::ranges::lower_bound(sights_, low, {}, height);
         s != sights_.end() && s->direction.y <= high; ++s) {
      const double u = glm::dot(s->direction, bc), v = glm::dot(s->direction, ca),
                   w = glm::dot(s->direction, ab);
      const bool isWithin = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
      const double distance = volume / (u + v + w);
      const bool showsBack = !isDoubleSided && u + v + w > 0;
      if (isWithin && distance > 0 && isNearer(distance, showsBack, *s))
        s->distance = distance, s->normal = glm::normalize(normal), s->showsBack = showsBack;
    }
  }

  std::vector<Sight> take() { return std::move(sights_); }

 private:
  // Of a front and a back at the same place, walls modelled by two coincident surfaces, the front.
  static bool isNearer(double distance, bool showsBack, const Sight& than) {
    constexpr double kSame = 1e-6;
    if (std::fabs(distance - than.distance) <= kSame * distance) return !showsBack;
    return distance < than.distance;
  }

  // Bounds of the heights of unit directions to the triangle, by its bounding sphere.
  static std::pair<double, double> heights(const dvec3& a, const dvec3& b, const dvec3& c) {
    constexpr double kRounding = 1e-6;
    const dvec3 centre = (a + b + c) / 3.0;
    const double radius =
        std::max({glm::length(a - centre), glm::length(b - centre), glm::length(c - centre)});
    const double distance = glm::length(centre);
    if (!(radius < distance)) return {-1, 1};
    const double elevation = std::asin(std::clamp(centre.y / distance, -1.0, 1.0));
    const double angle = std::asin(radius / distance) + kRounding;
    return {elevation - angle < -kPiD / 2 ? -1 : std::sin(elevation - angle),
            elevation + angle > kPiD / 2 ? 1 : std::sin(elevation + angle)};
  }

  dvec3 eye_;
  std::vector<Sight> sights_;
};

}  // namespace

std::vector<Sight> sightsFrom(const Scene& scene, const std::vector<int>& instances,
                              const dvec3& eye) {
  EyeView panorama(eye);
  for (const int i : instances) {
    const Instance& instance = scene.instances[size_t(i)];
    const bool isDoubleSided = scene.materials[size_t(instance.material)].doubleSided;
    forTriangles(scene, instance, 0, triangleCount(scene, instance),
                 [&](const Corners& c) { panorama.add(c, isDoubleSided); });
  }
  return panorama.take();
}

}  // namespace chromeball
