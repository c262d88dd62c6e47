// Where the picture is taken from.
#pragma once

#include <string>

#include "math/vec.h"

namespace chromeball {

// Looks along -Z of its frame, +Y up (glTF's convention). Positions in metres.
struct Camera {
  std::string name;
  vec3 position{0, 0, 0};
  vec3 right{1, 0, 0}, up{0, 1, 0}, back{0, 0, 1};  // orthonormal
  bool orthographic = false;
  float fov = 0.6911112f;  // vertical field of view in radians (perspective)
  float halfHeight = 1;    // half the height of the view in metres (orthographic)
  float aspect = 0;        // width / height the file asks for; 0: none

  // The ray through image point (u right, v down, both in [0, 1]) of a picture with the given
  // width / height. The direction is unit.
  void ray(float u, float v, float aspectRatio, vec3& origin, vec3& direction) const;

  // Throws InputError where eye and target coincide or up is parallel to the view.
  static Camera lookAt(vec3 position, vec3 target, vec3 up, float fovRadians);
};

}  // namespace chromeball
