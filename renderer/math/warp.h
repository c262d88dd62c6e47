// SPDX-License-Identifier: Apache-2.0
// Warps from the unit square to directions and triangles, with their pdfs.
// Hemispheres are about +z. Pdfs are over solid angle.
#pragma once

#include "math/vec.h"

namespace chromeball {

// The unit vector with the given z and azimuth, in turns.
inline vec3 unitVector(float z, float azimuthTurns) {
  float sine, cosine;
  sinCosTurns(azimuthTurns, sine, cosine);
  const float r = std::sqrt(std::max(0.0f, (1 - z) * (1 + z)));
  return {r * cosine, r * sine, z};
}

// The azimuth of v about z in turns, [0, 1).
inline float azimuthTurns(const vec3& v) {
  const float turns = atan2Turns(v.y, v.x);
  return turns < 0 ? turns + 1 : turns;
}

inline vec3 squareToUniformSphere(vec2 u) { return unitVector(1 - 2 * u.y, u.x); }
inline float squareToUniformSpherePdf() { return 0.25f * kInvPi; }
inline vec2 uniformSphereToSquare(const vec3& v) { return {azimuthTurns(v), (1 - v.z) / 2}; }

inline vec3 squareToUniformHemisphere(vec2 u) { return unitVector(1 - u.y, u.x); }
inline float squareToUniformHemispherePdf(const vec3& v) { return v.z >= 0 ? 0.5f * kInvPi : 0; }

// Pdf cos(theta)/pi: lifts a uniform point of the unit disc, at radius sqrt(u.y), to the hemisphere
// (Malley's method).
inline vec3 squareToCosineHemisphere(vec2 u) {
  float sine, cosine;
  sinCosTurns(u.x, sine, cosine);
  const float r = std::sqrt(u.y);
  return {r * cosine, r * sine, std::sqrt(1 - u.y)};
}
inline float squareToCosineHemispherePdf(const vec3& v) { return v.z > 0 ? v.z * kInvPi : 0; }

// Barycentric coordinates (of the second and third vertex), uniform over the triangle's area, pdf
// 1/area (Heitz 2019, "A Low-Distortion Map Between Triangle and Square").
inline vec2 squareToTriangle(vec2 u) {
  if (u.y > u.x) return {u.x / 2, u.y - u.x / 2};
  return {u.x - u.y / 2, u.y / 2};
}

// A disc on the sphere of directions.

// Measured by chords: the chord from the centre to a direction is accurate for discs of any size,
// and its square is uniform over the disc's solid angle, pi chord^2.
struct SphericalCap {
  Frame frame;         // z: towards the centre
  float squaredChord;  // from the centre to the rim: solid angle / pi; 4 is the whole sphere

  bool contains(const vec3& wi) const {
    const vec3 to = wi - frame.z;
    return glm::dot(to, to) <= squaredChord;
  }

  // A direction uniform over the solid angle, from two numbers in [0, 1).
  vec3 direction(float u, float v) const {
    const float squared = u * squaredChord;
    float sine, cosine;
    sinCosTurns(v, sine, cosine);
    const float r = std::sqrt(squared * (1 - squared / 4));
    return frame.toWorld({r * cosine, r * sine, 1 - squared / 2});
  }
};

}  // namespace chromeball
