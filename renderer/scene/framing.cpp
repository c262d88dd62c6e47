// SPDX-License-Identifier: Apache-2.0
#include "scene/framing.h"

#include "base/parallel.h"
#include "scene/bounds.h"

namespace chromeball {
namespace {

constexpr float kFov = 47 * kPi / 180;
constexpr double kMargin = 1.05;

// Fits the camera along one axis of the image, for a view whose edges have the given `slope`. With
// the camera at `position` along the axis and at `distance` from the origin, a vertex at x and z
// (towards the camera) is in view if
//   |x - position| <= (distance - z) slope.
// The extremes of x + z slope and -x + z slope give the smallest distance for which this holds.
struct AxisFit {
  double slope;
  double upper = -INFINITY, lower = -INFINITY;

  void add(double x, double z) {
    upper = std::max(upper, x + z * slope);
    lower = std::max(lower, -x + z * slope);
  }
  void add(const AxisFit& other) {
    upper = std::max(upper, other.upper);
    lower = std::max(lower, other.lower);
  }
  double position() const { return 0.5 * (upper - lower); }
  double distance() const { return 0.5 * (upper + lower) / slope; }
};

struct ImageFit {
  AxisFit across, upwards;
};

bool isFlat(const Bounds& box) {
  constexpr float kFlat = 20;
  const vec3 size = box.max - box.min;
  return std::max(size.x, size.z) > kFlat * size.y;
}

bool reachesBeyond(const Bounds& box, const Bounds& others) {
  const vec3 size = others.max - others.min;
  const float maximum = std::max(size.x, size.z);
  return box.min.x < others.min.x - maximum || box.max.x > others.max.x + maximum ||
         box.min.z < others.min.z - maximum || box.max.z > others.max.z + maximum;
}

// The instances to frame: all except ground planes.
std::vector<int> subjects(const Scene& scene) {
  std::vector<Bounds> boxes;
  Bounds upright;
  for (const Instance& instance : scene.instances) {
    boxes.push_back(bounds(scene, instance));
    if (!isFlat(boxes.back())) upright.add(boxes.back());
  }
  std::vector<int> chosen;
  for (size_t i = 0; i < boxes.size(); ++i)
    if (upright.empty() || !isFlat(boxes[i]) || !reachesBeyond(boxes[i], upright))
      chosen.push_back(int(i));
  return chosen;
}

}  // namespace

vec3 centreOf(const Scene& scene) {
  const Bounds box = bounds(scene, subjects(scene));
  return box.empty() ? vec3(0) : 0.5f * box.min + 0.5f * box.max;
}

Camera framingCamera(const Scene& scene, float aspectRatio) {
  const std::vector<int> framed = subjects(scene);
  if (const auto inside = interiorView(scene, framed)) return *inside;
  const Bounds box = bounds(scene, framed);
  glm::dvec3 centre(0), size(0);
  if (!box.empty()) {
    centre = 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max));
    size = box.size();
  }
  Camera camera = Camera::lookAt({0.45f, 0.35f, 1}, vec3(0), vec3(0, 1, 0), kFov);
  const glm::dvec3 right(camera.right), up(camera.up), back(camera.back);

  // A scene without extent gets a view of about a metre, or wider if rounding errors of coordinates
  // far from the origin require it.
  if (glm::length(size) <= 1e-6 * glm::length(centre)) {
    camera.position = vec3(centre + (2 + 1e-3 * glm::length(centre)) * back);
    return camera;
  }

  const double slope = std::tan(0.5 * kFov) / kMargin;
  ImageFit fit{{slope * aspectRatio}, {slope}};
  for (const int i : framed) {
    const Instance& instance = scene.instances[size_t(i)];
    const std::vector<vec3>& positions = scene.meshes[size_t(instance.mesh)].positions;
    const auto addVertices = [&](size_t begin, size_t end, ImageFit& part) {
      for (size_t k = begin; k < end; ++k) {
        const glm::dvec3 p = glm::dvec3(instance.point(positions[k])) - centre;
        const double z = glm::dot(p, back);
        part.across.add(glm::dot(p, right), z);
        part.upwards.add(glm::dot(p, up), z);
      }
    };
    fit = joinRanges(positions.size(), kElementsOfTask, fit, addVertices,
                     [](ImageFit& to, const ImageFit& other) {
                       to.across.add(other.across);
                       to.upwards.add(other.upwards);
                     });
  }
  const double distance = std::max(fit.across.distance(), fit.upwards.distance());
  camera.position =
      vec3(centre + fit.across.position() * right + fit.upwards.position() * up + distance * back);
  return camera;
}

Camera framingCameraAround(const Scene& scene, float aspectRatio) {
  const std::vector<int> framed = subjects(scene);
  const vec3 centre = centreOf(scene);
  float squaredRadius = 0;
  for (const int i : framed) {
    const Instance& instance = scene.instances[size_t(i)];
    for (const vec3& position : scene.meshes[size_t(instance.mesh)].positions) {
      const vec3 p = instance.point(position) - centre;
      squaredRadius = std::max(squaredRadius, glm::dot(p, p));
    }
  }
  const float radius = std::sqrt(squaredRadius);
  Camera camera = framingCamera(scene, aspectRatio);
  if (radius <= 1e-6f * glm::length(centre)) return camera;
  // The sphere touches the narrower pair of the view's planes.
  const double slope = std::tan(0.5 * kFov) / kMargin * std::min(1.0, double(aspectRatio));
  const double distance = radius * std::sqrt(1 + 1 / (slope * slope));
  camera = Camera::lookAt({0.45f, 0.35f, 1}, vec3(0), vec3(0, 1, 0), kFov);
  camera.position = vec3(glm::dvec3(centre) + distance * glm::dvec3(camera.back));
  return camera;
}

}  // namespace chromeball
