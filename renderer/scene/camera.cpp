#include "scene/camera.h"

#include "math/error.h"

namespace chromeball {

CameraRays::CameraRays(const Camera& camera, float aspectRatio)
    : orthographic_(camera.orthographic), position_(camera.position), forward_(-camera.back) {
  const float halfHeight = orthographic_ ? camera.halfHeight : std::tan(0.5f * camera.fov);
  across_ = 2 * halfHeight * aspectRatio * camera.right;
  down_ = -2 * halfHeight * camera.up;
  corner_ = -0.5f * (across_ + down_);
  if (!orthographic_) corner_ += forward_;
}

Camera Camera::lookAt(vec3 position, vec3 target, vec3 up, float fovRadians) {
  const glm::dvec3 view = glm::dvec3(position) - glm::dvec3(target);
  const double distance = glm::length(view);
  if (!(distance > 0) || !std::isfinite(distance))
    throwInput("camera: position and look_at are the same point, or not finite");
  const glm::dvec3 back = view / distance;
  const glm::dvec3 side = glm::cross(glm::dvec3(up), back);
  const double sideLength = glm::length(side);
  if (!(sideLength > 1e-6 * glm::length(glm::dvec3(up))))
    throwInput("camera: up is zero or parallel to the view");

  Camera camera;
  camera.position = position;
  camera.right = vec3(side / sideLength);
  camera.up = vec3(glm::cross(back, side / sideLength));
  camera.back = vec3(back);
  camera.fov = fovRadians;
  return camera;
}

}  // namespace chromeball
