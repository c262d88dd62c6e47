// SPDX-License-Identifier: Apache-2.0
// Lights that are no part of a model's surfaces, and the units that files state them in.
#pragma once

#include <string>

#include "math/vec.h"

namespace chromeball {

// How a file's candela and lux become W/sr and W/m^2: at 683 lm/W, as Blender writes and reads
// them, or as if they were radiometric units already.
enum class LightUnits : uint8_t { Photometric, Radiometric };

constexpr float lumensPerWatt(LightUnits units) {
  return units == LightUnits::Photometric ? 683.0f : 1.0f;
}

struct PunctualLight {
  enum class Kind : uint8_t { Directional, Point, Spot };

  Kind kind = Kind::Point;
  Rgb intensity{1};          // W/sr; of a directional one, irradiance on a surface that faces it
  vec3 position{0};          // metres
  vec3 direction{0, 0, -1};  // unit, where it shines
  float range = INFINITY;    // metres at which it has faded to nothing
  float cosInner = 1, cosOuter = 0.70710678f;  // of a spot's cone: full light within, none without

  // W/sr of a lamp that sends out 1 W: the inverse of the integral of its falloff over directions.
  float intensityOfOneWatt() const;
};

// A round lamp that shines evenly to one side.
struct DiscLamp {
  vec3 position{0};          // of the centre, metres
  vec3 direction{0, 0, -1};  // unit, where it shines
  float radius = 1;
  Rgb radiance{1};
};

}  // namespace chromeball
