#include "scene/framing.h"

namespace chromeball {
namespace {

constexpr float kFov = 47 * kPi / 180;
constexpr double kMargin = 1.05;

// Of what a view whose edges rise by `slope` a metre must hold, along one axis of the picture: how
// far the vertices reach past edges through the origin. With a camera at `position` along the axis
// and `distance` behind the origin, a vertex at x and (towards the camera) z is in view where
//   |x - position| <= (distance - z) slope.
struct Reach {
  double slope;
  double upper = -INFINITY, lower = -INFINITY;

  void add(double x, double z) {
    upper = std::max(upper, x + z * slope);
    lower = std::max(lower, -x + z * slope);
  }
  double position() const { return 0.5 * (upper - lower); }
  double distance() const { return 0.5 * (upper + lower) / slope; }
};

}  // namespace

Camera framingCamera(const Scene& scene, float aspectRatio) {
  const Bounds box = bounds(scene);
  glm::dvec3 centre(0), size(0);
  if (!box.empty()) {
    centre = 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max));
    size = glm::dvec3(box.max) - glm::dvec3(box.min);
  }
  Camera camera = Camera::lookAt({0.45f, 0.35f, 1}, vec3(0), vec3(0, 1, 0), kFov);
  const glm::dvec3 right(camera.right), up(camera.up), back(camera.back);

  // Something to look at where there is no extent: a view as wide as the distance from the origin
  // can resolve, or of a metre.
  if (glm::length(size) <= 1e-6 * glm::length(centre)) {
    camera.position = vec3(centre + (2 + 1e-3 * glm::length(centre)) * back);
    return camera;
  }

  const double slope = std::tan(0.5 * kFov) / kMargin;
  Reach across{slope * aspectRatio}, upwards{slope};
  for (const Instance& instance : scene.instances)
    for (const vec3& position : scene.meshes[instance.mesh].positions) {
      const glm::dvec3 p = glm::dvec3(instance.point(position)) - centre;
      const double z = glm::dot(p, back);
      across.add(glm::dot(p, right), z);
      upwards.add(glm::dot(p, up), z);
    }
  const double distance = std::max(across.distance(), upwards.distance());
  camera.position =
      vec3(centre + across.position() * right + upwards.position() * up + distance * back);
  return camera;
}

}  // namespace chromeball
