// SPDX-License-Identifier: Apache-2.0
// Vectors, colours and shared constants. Colours are linear Rec. 709 throughout.
//
// Use std::max and std::min: fmax and fmin are function calls without -ffast-math.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace chromeball {

using glm::mat3;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using Rgb = glm::vec3;  // linear Rec. 709, D65

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kInvPi = 1 / kPi;
inline constexpr double kPiD = 3.14159265358979323846;

inline float luminance(const Rgb& c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }
inline double luminance(const glm::dvec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }
inline float maxComponent(const Rgb& c) { return std::max(c.x, std::max(c.y, c.z)); }
// glm::abs branches on the sign of each component.
inline vec3 absolute(const vec3& v) { return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}; }
inline bool isBlack(const Rgb& c) { return c.x == 0 && c.y == 0 && c.z == 0; }
inline bool isFinite(const Rgb& c) {
  return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

}  // namespace chromeball
