// SPDX-License-Identifier: Apache-2.0
// Assigns the energy of each cell of a map to the nearest of given directions.
#pragma once

#include <vector>

#include "lighting/constellation/texel_table.h"

namespace chromeball {

// Sums over blocks of 2 x 2 cells, 4 x 4 cells, ... up to the whole map.
class BlockPyramid {
 public:
  explicit BlockPyramid(const TexelTable& table);  // must outlive this

  // The irradiance (RGB) of a light in each of `directions` (unit, at least one). A block of cells
  // whose radius is less than a fifth of its distance to all lights is assigned as a whole to the
  // light nearest to its middle. A cell that contains lights is divided equally among them, so a
  // light in a lit cell is never black.
  std::vector<dvec3> assignToNearest(const std::vector<dvec3>& directions) const;

 private:
  // A patch of the sphere. All its points are within `radius` of the middle, measured as a chord.
  struct Block {
    dvec3 power, middle;
    double radius;
  };
  struct Level {
    glm::ivec2 size;
    std::vector<Block> blocks;
  };
  struct Assignment;

  Block makeBlock(const dvec3& power, int size, int x, int y) const;  // size: in cells
  Block block(int level, int x, int y) const;
  void assign(Assignment& assignment, int level, int x, int y) const;

  const TexelTable& table_;
  std::vector<Level> levels_;  // levels_[k - 1] is level k, blocks of 2^k cells a side
};

}  // namespace chromeball
