// SPDX-License-Identifier: Apache-2.0
// Rectangles of a lat-long map: their sums in constant time, and repeated subdivision.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "lighting/constellation/directional_light.h"
#include "lighting/constellation/texel_table.h"

namespace chromeball {

using glm::dvec4;

// Cells [x0, x1) x [y0, y1) of the table.
struct Region {
  int x0, y0, x1, y1;
};

// What the weight of a cell, and the size of a region, are measured by: solid angles on the sphere,
// or areas in the map, as if it were a flat picture.
enum class RegionMeasure { SolidAngle, MapArea };

// Where the light of a region is: at the energy centroid of its directions, or at the direction
// that the middle of the rectangle shows.
enum class LightPlace { Centroid, Centre };

// Summed-area tables (Crow 1984) over the cells of a TexelTable.
class RegionTable {
 public:
  explicit RegionTable(const Image& latLong, RegionMeasure measure = RegionMeasure::SolidAngle);

  const TexelTable& texels() const { return texels_; }
  RegionMeasure measure() const { return measure_; }

  // Sum of (direction x weight, weight); a cell's weight is luminance x its measure. As a
  // difference of sums over the map it has an error of about 1e-15 of the map's total, so a black
  // region may have a small weight.
  dvec4 moment(const Region& r) const;
  int litCells(const Region& r) const;  // exact

  // The smallest rectangle around the lit cells of `r` (at least one). Any line through it leaves
  // light on both sides.
  Region trimmed(const Region& r) const;

  // One light for each region. Sums its cells, not table entries, so energy is kept.
  Constellation lights(const std::vector<Region>& regions,
                       LightPlace place = LightPlace::Centroid) const;

  // The regions as labels of the texels of the table's map.
  Partition partition(const Image& latLong, const std::vector<Region>& regions) const;

 private:
  size_t corner(int x, int y) const { return size_t(y) * (texels_.width() + 1) + x; }

  TexelTable texels_;
  RegionMeasure measure_;
  std::vector<dvec4> moments_;  // (width + 1) x (height + 1)
  std::vector<int32_t> lit_;
};

// The two parts of `r` left and right of column x, or above and below row y.
std::pair<Region, Region> cutAtColumn(const Region& r, int x);
std::pair<Region, Region> cutAtRow(const Region& r, int y);

// Starting from the whole map, repeatedly cuts the region of highest `priority` among those with
// two or more lit cells, until there are `count` regions or none can be cut. Regions are trimmed
// and together contain all lit cells.
std::vector<Region> subdivide(const RegionTable& table, int count,
                              const std::function<double(const Region&)>& priority,
                              const std::function<std::pair<Region, Region>(const Region&)>& cut);

}  // namespace chromeball
