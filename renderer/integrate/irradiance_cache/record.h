// SPDX-License-Identifier: Apache-2.0
// Irradiance at one point, with what is needed to extrapolate it (Ward and Heckbert 1992,
// "Irradiance Gradients").
#pragma once

#include <array>
#include <cmath>

#include "math/vec.h"

namespace chromeball {

struct IrradianceRecord {
  vec3 position{0};                   // metres
  vec3 normal{0};                     // unit
  Rgb irradiance{0};                  // W/m^2
  std::array<vec3, 3> rotation{};     // gradient of each channel, W/m^2 per radian of rotation axis
  std::array<vec3, 3> translation{};  // gradient of each channel, W/m^2 per metre
  float radius = 0;       // metres; at most the harmonic mean distance of what the point sees
  float leastRadius = 0;  // neighbours do not lower it further

  // The change of irradiance to be expected at another point, as a fraction: |x - x_i| / R_i +
  // sqrt(1 - n.n_i) (Ward, Rubinstein and Clear 1988, equation 5, without its constants).
  float errorAt(const vec3& x, const vec3& n) const {
    const float turned = std::sqrt(std::max(1 - glm::dot(n, normal), 0.0f));
    const float distance = glm::length(x - position);
    return (distance > 0 ? distance / radius : 0) + turned;
  }

  // Whether the point is behind the record's surface and a part of what the record sees is not
  // seen from there (Ward et al. 1988, equation 6).
  bool isInFront(const vec3& x, const vec3& n) const {
    return glm::dot(x - position, n + normal) < -0.02f * radius;
  }

  Rgb irradianceAt(const vec3& x, const vec3& n) const {
    const vec3 turn = glm::cross(normal, n), shift = x - position;
    Rgb sum = irradiance;
    for (int c = 0; c < 3; ++c)
      sum[c] += glm::dot(turn, rotation[size_t(c)]) + glm::dot(shift, translation[size_t(c)]);
    return glm::max(sum, Rgb(0));
  }
};

}  // namespace chromeball
