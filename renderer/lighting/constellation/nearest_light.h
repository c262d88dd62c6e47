// SPDX-License-Identifier: Apache-2.0
// The light of a map shared out among given directions: each cell's goes to the nearest.
#pragma once

#include <vector>

#include "lighting/constellation/texel_table.h"

namespace chromeball {

// Sums over blocks of 2 x 2 cells of a table, of 4 x 4, and so on up to the whole map.
class BlockPyramid {
 public:
  explicit BlockPyramid(const TexelTable& table);  // must outlive this

  // What each light gets, RGB irradiance. A block of cells whose radius is less than a fifth of its
  // distance to all lights goes whole to the one nearest to its middle. The power of a cell that
  // holds lights is shared equally among these, so that lights in lit cells are never black.
  // `directions` are unit, at least one.
  std::vector<dvec3> fraction(const std::vector<dvec3>& directions) const;

 private:
  // A patch of the sphere: no point of it is farther from the middle than `radius`, as a chord.
  struct Block {
    dvec3 power, middle;
    double radius;
  };
  struct Level {
    glm::ivec2 size;
    std::vector<Block> blocks;
  };
  struct Sharing;

  Block makeBlock(const dvec3& power, int size, int x, int y) const;  // size: in cells
  Block block(int level, int x, int y) const;
  void fraction(Sharing& sharing, int level, int x, int y) const;

  const TexelTable& table_;
  std::vector<Level> levels_;  // levels_[k - 1] is level k, blocks of 2^k cells a side
};

}  // namespace chromeball
