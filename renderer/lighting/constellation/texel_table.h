// SPDX-License-Identifier: Apache-2.0
// A lat-long map as a grid of weighted directions: the input of the constellation methods.
#pragma once

#include <functional>
#include <utility>
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

// Rectangles of a lat-long map: their sums in constant time, and repeated subdivision.

using glm::dvec4;

// Cells [x0, x1) x [y0, y1) of the table.
struct Region {
  int x0, y0, x1, y1;
};

// The measure of a cell's weight and of a region's size: solid angles on the sphere, or areas in
// the map, as if it were a flat picture.
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
