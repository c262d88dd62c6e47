// SPDX-License-Identifier: Apache-2.0
// `penrose` (Ostromoukhov, Donohue and Jodoin 2004): lights on the corners of a Penrose tiling that
// is subdivided where the map is bright.
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/constellation/nearest_light.h"
#include "lighting/constellation/texel_table.h"

namespace chromeball {

// Importance over the map, luminance x solid angle / area in the map, constant in each cell, with
// its greatest in any rectangle. Points are (2 u, v): square texels in a 2:1 map.
class ImportanceTable {
 public:
  explicit ImportanceTable(const Image& latLong);
  ImportanceTable(const ImportanceTable&) = delete;

  const TexelTable& texels() const { return texels_; }

  double at(const dvec2& p) const;  // 0 outside the map

  // At least the importance of every point of the rectangle.
  double bound(const dvec2& low, const dvec2& high) const;

  const BlockPyramid& blocks() const { return blocks_; }

 private:
  struct Level {
    int width, height;
    std::vector<double> greatest;
  };
  TexelTable texels_;
  BlockPyramid blocks_;
  std::vector<Level> levels_;  // of cells, then of 2 x 2 of the level before, up to one
};

// The corners that appear when the tiling's triangles are subdivided for the k-th time share the
// ranks from phi^2k to phi^2k+2, evenly over any neighbourhood. Those `count` corners with the
// least rank / importance become lights: their pdf is proportional to the importance, and they
// keep their distance from each other. The light of each cell goes to the nearest of them: given
// equal shares, as the paper has it, 300 lights miss the irradiance by 2% on average, so by 0.4%.
// The seed places the tiling on the map. The published tables that move points for a better
// spectrum are left out, and points near the map's seam and poles do not know each other.
Constellation penrose(const ImportanceTable& table, int count, uint64_t seed);

}  // namespace chromeball
