// SPDX-License-Identifier: Apache-2.0
// A lat-long map as a grid of weighted directions: the input of the constellation methods.
#pragma once

#include <vector>

#include "image/image.h"
#include "lighting/constellation/directional_light.h"
#include "math/vec.h"

namespace chromeball {

using glm::dvec2;
using glm::dvec3;

// Sums over texels. In double, so that texels beside a sun of radiance 1e12 are not lost.
struct TexelSum {
  dvec3 power{0};     // radiance x solid angle, RGB: the irradiance of a light that replaces them
  dvec3 moment{0};    // direction x weight
  double weight = 0;  // luminance of power

  TexelSum& operator+=(const TexelSum& other);
};

// The light that replaces `sum`, at its centroid on the sphere; at `fallback` (unit) if the
// centroid is so near to the sphere's centre that it has no direction.
DirectionalLight lightAt(const TexelSum& sum, const dvec3& fallback);
DirectionalLight makeLight(const dvec3& unitDirection, const dvec3& irradiance);

// Maximum numbers of cells, to bound memory and time.
inline constexpr size_t kFineCells = 1 << 21;    // 2048 x 1024: for look-ups
inline constexpr size_t kCoarseCells = 1 << 15;  // 256 x 128: for repeated loops over all cells

// Cells are square blocks of texels, as small as possible with at most `maxCells` cells: single
// texels unless the map is large. All light of a texel is treated as coming from its centre.
class TexelTable {
 public:
  // Throws InputError for an empty map, fewer than three channels, a texel that is negative or not
  // finite, and a sum of radiance beyond the range of a float.
  TexelTable(const Image& latLong, size_t maxCells);

  int width() const { return width_; }
  int height() const { return height_; }
  int block() const { return block_; }  // texels along a cell's side; the last may have fewer
  const TexelSum& at(int x, int y) const { return cells_[size_t(y) * width_ + x]; }
  const std::vector<TexelSum>& cells() const { return cells_; }
  size_t cellOfTexel(int x, int y) const { return size_t(y / block_) * width_ + x / block_; }
  const TexelSum& total() const { return total_; }

  // The position (u, v) in [0, 1]^2 of a point given in cells, and its direction.
  dvec2 uv(double x, double y) const {
    return {std::fmin(x * block_ / mapWidth_, 1.0), std::fmin(y * block_ / mapHeight_, 1.0)};
  }
  dvec3 direction(double x, double y) const;
  glm::ivec2 cellAt(const dvec2& uv) const;  // the cell there, or the nearest

 private:
  int mapWidth_, mapHeight_, block_, width_, height_;
  std::vector<TexelSum> cells_;
  TexelSum total_;
};

}  // namespace chromeball
