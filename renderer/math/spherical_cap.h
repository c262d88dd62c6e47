// SPDX-License-Identifier: Apache-2.0
// A disc on the sphere of directions.
#pragma once

#include "math/frame.h"
#include "math/trig.h"

namespace chromeball {

// Measured by chords: the chord from the centre to a direction is accurate for discs of any size,
// and its square is uniform over the disc's solid angle, pi chord^2.
struct SphericalCap {
  Frame frame;         // z: towards the centre
  float squaredChord;  // from the centre to the rim: solid angle / pi; 4 is the whole sphere

  bool contains(const vec3& wi) const {
    const vec3 to = wi - frame.z;
    return glm::dot(to, to) <= squaredChord;
  }

  // Uniform over the solid angle, from two numbers in [0, 1).
  vec3 direction(float u, float v) const {
    const float squared = u * squaredChord;
    float sine, cosine;
    sinCosTurns(v, sine, cosine);
    const float r = std::sqrt(squared * (1 - squared / 4));
    return frame.toWorld({r * cosine, r * sine, 1 - squared / 2});
  }
};

}  // namespace chromeball
