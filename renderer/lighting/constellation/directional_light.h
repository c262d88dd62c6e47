// SPDX-License-Identifier: Apache-2.0
// Lights infinitely far away: the elements of constellations and fits, and extracted suns.
#pragma once

#include <cstdint>
#include <vector>

#include "math/rotation.h"
#include "math/vec.h"

namespace chromeball {

struct DirectionalLight {
  vec3 direction;   // unit, from the scene to the light
  Rgb irradiance;   // on a surface that faces it, W/m^2
  float angle = 0;  // angular diameter, degrees; 0: a delta light
};

using Constellation = std::vector<DirectionalLight>;

// The lights of a probe that is turned.
inline Constellation turned(Constellation lights, const Rotation& rotation) {
  for (DirectionalLight& light : lights) light.direction = rotation(light.direction);
  return lights;
}

// The regions of a map that lights replace.

inline constexpr uint16_t kNoRegion = 65535;

// For each texel of a lat-long map, row by row, the index of its region: 0 to regions - 1, or
// kNoRegion for a black texel that no light stands for.
struct Partition {
  int regions = 0;
  std::vector<uint16_t> label;
};

// A straight line in the map, between two positions (u, v).
struct MapLine {
  glm::dvec2 from, to;
};

// The part of the map that each light of a constellation stands for: regions, or the tiling whose
// corners are lights.
struct LightRegions {
  Partition partition;
  std::vector<MapLine> tiling;
};

}  // namespace chromeball
