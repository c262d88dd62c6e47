// SPDX-License-Identifier: Apache-2.0
// The rays of a camera that moves while the shutter is open.
#pragma once

#include <vector>

#include "scene/camera.h"

namespace chromeball {

// Between two keys (scene/motion.h) the position moves along a straight line, and the frame turns
// about one axis at constant speed.
class MovingCamera {
 public:
  // For an image of the given width / height. The camera has a motion.
  MovingCamera(const Camera& camera, float aspectRatio);

  Camera cameraAt(float time) const;  // stands still
  CameraRays at(float time) const { return {cameraAt(time), aspectRatio_}; }

 private:
  struct Key {
    vec3 position;
    glm::quat frame;  // turns the axes to right, up and back
    float fov, halfHeight;
  };
  Camera lens_;  // what does not move
  float aspectRatio_;
  std::vector<Key> keys_;
};

}  // namespace chromeball
