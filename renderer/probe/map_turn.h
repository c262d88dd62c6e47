// SPDX-License-Identifier: Apache-2.0
// How a lat-long map is turned where directions are looked up in it.
#pragma once

#include "math/rotation.h"

namespace chromeball {

// A yaw shifts the map's u. A tilt is a matrix that is applied to the directions, and not to the
// map, which is never resampled; without one it costs a branch that is always predicted.
class MapTurn {
 public:
  explicit MapTurn(const Rotation& rotation)
      : isTilted_(rotation.isTilted()),
        uShift_(isTilted_ ? 0 : -rotation.yaw() / 360),
        toWorld_(glm::mat3_cast(rotation.quaternion())) {
    uShift_ -= std::floor(uShift_);
  }

  // In turns, [0, 1): of the map that is turned, minus that of the map itself.
  float uShift() const { return uShift_; }
  // To and from the frame in which the map is shifted by uShift().
  vec3 toMap(const vec3& d) const {
    if (isTilted_) [[unlikely]]
      return d * toWorld_;  // the transpose
    return d;
  }
  vec3 toWorld(const vec3& d) const {
    if (isTilted_) [[unlikely]]
      return toWorld_ * d;
    return d;
  }

 private:
  bool isTilted_;
  float uShift_;
  mat3 toWorld_;
};

}  // namespace chromeball
