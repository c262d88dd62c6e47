// SPDX-License-Identifier: Apache-2.0
// Rectangles of a lat-long map, their light in constant time, and cutting them one after another.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "lighting/constellation/texel_table.h"

namespace chromeball {

using glm::dvec4;

// Cells [x0, x1) x [y0, y1) of the table.
struct Region {
  int x0, y0, x1, y1;
};

// Summed-area tables (Crow 1984) over the cells of a TexelTable.
class RegionTable {
 public:
  explicit RegionTable(const Image& latLong);

  const TexelTable& texels() const { return texels_; }

  // Sum of (direction x weight, weight). A difference of sums over the map: exact to about 1e-15 of
  // the whole map's, so a black region may seem to have a weight.
  dvec4 moment(const Region& r) const;
  int litCells(const Region& r) const;  // exact

  // The smallest rectangle around the lit cells of `r`, of which there must be one. Any line
  // through it leaves light on both sides.
  Region trimmed(const Region& r) const;

  // One light for each region: the sum of its cells, not of table entries, so all energy is kept.
  Constellation lights(const std::vector<Region>& regions) const;

 private:
  size_t corner(int x, int y) const { return size_t(y) * (texels_.width() + 1) + x; }

  TexelTable texels_;
  std::vector<dvec4> moments_;  // (width + 1) x (height + 1)
  std::vector<int32_t> lit_;
};

// The two parts of `r` left and right of column x, or above and below row y.
std::pair<Region, Region> cutAtColumn(const Region& r, int x);
std::pair<Region, Region> cutAtRow(const Region& r, int y);

// Cuts the region whose `priority` is greatest, of those with two lit cells or more, until there
// are `count` or none is left to cut. Regions are trimmed, and together hold all lit cells.
std::vector<Region> subdivide(const RegionTable& table, int count,
                              const std::function<double(const Region&)>& priority,
                              const std::function<std::pair<Region, Region>(const Region&)>& cut);

}  // namespace chromeball
