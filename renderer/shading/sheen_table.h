// SPDX-License-Identifier: Apache-2.0
// Albedo of the white sheen lobe, which attenuates the layers beneath.
#pragma once

#include "math/grid_table.h"

namespace chromeball {

// Over perceptual roughness and the cosine of the viewing angle. 24 x 32 nodes, 3 KB; takes 0.14 s
// of one core to build, on all cores.
class SheenTable {
 public:
  SheenTable();

  // `mu`: cosine of the viewing angle; roughness in [charlie::kMinRoughness, 1].
  float albedo(float mu, float roughness) const;

 private:
  static constexpr int kRoughnesses = 24, kAngles = 32;
  GridTable<float, kRoughnesses, kAngles> grid_;
};

}  // namespace chromeball
