// Lights without extent, as a model states them (KHR_lights_punctual).
#pragma once

#include "math/vec.h"

namespace chromeball {

// Photometric units count as radiometric ones, as a probe's do: a candela as 1 W/sr, a lux as
// 1 W/m^2.
struct PunctualLight {
  enum class Kind : uint8_t { Directional, Point, Spot };

  Kind kind = Kind::Point;
  Rgb intensity{1};          // W/sr; of a directional one, irradiance on a surface that faces it
  vec3 position{0};          // metres
  vec3 direction{0, 0, -1};  // unit, where it shines
  float range = INFINITY;    // metres at which it has faded to nothing
  float cosInner = 1, cosOuter = 0.70710678f;  // of a spot's cone: full light within, none without
};

}  // namespace chromeball
