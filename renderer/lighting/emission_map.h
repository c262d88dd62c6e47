// SPDX-License-Identifier: Apache-2.0
// How much each triangle of a material with an emissive texture emits.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace chromeball {

// Sums of the emission's luminance over rectangles of the texture, from a summed-area table (Crow
// 1984) over cells of texels, at most kMaxCells a side.
class EmissionMap {
 public:
  static constexpr int kMaxCells = 512;

  // Precondition: the material has an emissive texture, which the scene has.
  EmissionMap(const Scene& scene, const Material& material);

  // An estimate of the mean luminance that a triangle emits, from the rectangle of texels around
  // it. 0 only if unfiltered lookups are black everywhere on the triangle.
  double mean(const Mesh& mesh, const Triangle& triangle) const;

 private:
  struct Range {
    int begin, end;  // cells
  };
  struct Sums {
    double luminance = 0;
    uint32_t lit = 0;  // texels that are not black
  };
  std::array<Range, 2> cellsOf(float from, float to, float error, int texels, Wrap wrap) const;
  Sums sumOf(Range columns, Range rows) const;

  const TextureSlot& slot_;
  const Texture& texture_;
  int cellSize_, columns_, rows_;
  double largest_ = 0;      // of a texel
  std::vector<Sums> sums_;  // (columns + 1) x (rows + 1): over the cells left of and above a corner
};

}  // namespace chromeball
