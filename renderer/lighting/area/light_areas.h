// SPDX-License-Identifier: Apache-2.0
// The shapes of area lights at infinity: parts of the sphere of directions.
#pragma once

#include <span>
#include <vector>

#include "math/vec.h"

namespace chromeball {

// A light of constant radiance over a solid angle.
struct AreaLight {
  vec3 direction;     // unit, towards its middle
  Rgb power;          // radiance x solid angle
  double solidAngle;  // steradians, above 0

  Rgb radiance() const { return Rgb(glm::dvec3(power) / solidAngle); }
};

class LightAreas {
 public:
  virtual ~LightAreas() = default;

  const std::vector<AreaLight>& lights() const { return lights_; }

  // What all lights together have in a direction.
  struct Found {
    Rgb radiance{0};
    float density = 0;  // sum of 1 / solid angle: the pdf of one direction in each light
  };
  virtual Found at(const vec3& wi) const = 0;
  // Adds the radiance of each light in a direction to its element.
  virtual void split(const vec3& wi, std::span<Rgb> radiances) const = 0;

  // A direction in a light, uniform over its solid angle, from two numbers in [0, 1).
  struct Sample {
    vec3 direction;
    Found found;  // there
  };
  virtual Sample sample(size_t light, double u, double v) const = 0;

 protected:
  std::vector<AreaLight> lights_;
};

}  // namespace chromeball
