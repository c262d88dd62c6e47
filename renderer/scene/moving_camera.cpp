// SPDX-License-Identifier: Apache-2.0
#include "scene/moving_camera.h"

#include "scene/motion.h"

namespace chromeball {

MovingCamera::MovingCamera(const Camera& camera, float aspectRatio)
    : lens_(camera), aspectRatio_(aspectRatio) {
  lens_.name.clear(), lens_.node.clear();  // at() must not allocate
  lens_.motion = nullptr;
  for (const Camera& key : *camera.motion)
    keys_.push_back(
        {key.position, glm::quat_cast(mat3(key.right, key.up, key.back)), key.fov, key.halfHeight});
}

Camera MovingCamera::cameraAt(float time) const {
  const KeySpan span = keysAround(keys_.size(), time);
  const Key &from = keys_[span.from], &to = keys_[span.to];
  const mat3 frame = glm::mat3_cast(glm::slerp(from.frame, to.frame, span.fraction));
  Camera camera = lens_;
  camera.position = glm::mix(from.position, to.position, span.fraction);
  camera.right = frame[0], camera.up = frame[1], camera.back = frame[2];
  camera.fov = glm::mix(from.fov, to.fov, span.fraction);
  camera.halfHeight = glm::mix(from.halfHeight, to.halfHeight, span.fraction);
  return camera;
}

}  // namespace chromeball
