// SPDX-License-Identifier: Apache-2.0
#include "description/scene_entries.h"

namespace chromeball {

Camera CameraEntry::relativeTo(const glm::dvec3& origin) const {
  Camera camera = Camera::lookAt(vec3(position - origin), vec3(target - origin), up, lens.fov);
  camera.orthographic = lens.orthographic;
  camera.halfHeight = lens.halfHeight;
  return camera;
}

Surroundings SurroundingsEntry::relativeTo(const glm::dvec3& origin) const {
  Surroundings s = shape;
  s.min = vec3(min - origin), s.max = vec3(max - origin);
  s.center = vec3(center - origin);
  s.capture = vec3(capture - origin);
  return s;
}

}  // namespace chromeball
