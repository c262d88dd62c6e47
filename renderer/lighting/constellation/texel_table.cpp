// SPDX-License-Identifier: Apache-2.0
#include "lighting/constellation/texel_table.h"

#include <limits>
#include <queue>

#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "probe/mapping.h"

namespace chromeball {
namespace {

int ceilDivide(int a, int b) { return a / b + (a % b != 0); }

int blockFor(int width, int height, size_t maxCells) {
  int block = 1;
  while (size_t(ceilDivide(width, block)) * ceilDivide(height, block) > maxCells) ++block;
  return block;
}

const Image& checked(const Image& latLong) {
  if (latLong.empty() || latLong.channels < 3)
    throwInput("probe: has no texels or fewer than three channels; RGB is needed");
  return latLong;
}

bool isValid(const Rgb& c) { return isFinite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0; }

// Smallest x in [low, high] for which the predicate holds, by bisection. Above it the predicate
// holds everywhere; it holds at `high`.
template <class Predicate>
int firstWhere(int low, int high, Predicate holds) {
  while (low < high) {
    const int middle = low + (high - low) / 2;
    if (holds(middle))
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

}  // namespace

TexelSum& TexelSum::operator+=(const TexelSum& other) {
  power += other.power;
  moment += other.moment;
  weight += other.weight;
  return *this;
}

DirectionalLight makeLight(const dvec3& unitDirection, const dvec3& irradiance) {
  return {vec3(unitDirection), Rgb(irradiance)};
}

DirectionalLight lightAt(const TexelSum& sum, const dvec3& fallback) {
  const double length = glm::length(sum.moment);
  return makeLight(length > 1e-6 * sum.weight ? sum.moment / length : fallback, sum.power);
}

TexelTable::TexelTable(const Image& latLong, size_t maxCells)
    : mapWidth_(checked(latLong).width),
      mapHeight_(latLong.height),
      block_(blockFor(mapWidth_, mapHeight_, maxCells)),
      width_(ceilDivide(mapWidth_, block_)),
      height_(ceilDivide(mapHeight_, block_)),
      cells_(longArray<TexelSum>(size_t(width_) * height_)) {
  std::vector<dvec2> column(mapWidth_);  // x and z of the direction on the horizon
  for (int x = 0; x < mapWidth_; ++x) {
    const double azimuth = 2 * kPiD * (x + 0.5) / mapWidth_;
    column[x] = {-std::sin(azimuth), std::cos(azimuth)};
  }
  parallelFor(0, height_, [&](int row) {
    for (int y = row * block_; y < std::min((row + 1) * block_, mapHeight_); ++y) {
      const double theta = kPiD * (y + 0.5) / mapHeight_;
      const double sine = std::sin(theta), cosine = std::cos(theta);
      const double solidAngle = texelSolidAngle(y, mapWidth_, mapHeight_);
      for (int x = 0; x < mapWidth_; ++x) {
        const Rgb radiance = latLong.rgb(x, y);
        if (!isValid(radiance))
          throwInput("probe: texel ({}, {}) is negative or not finite; repair the map", x, y);
        const dvec3 power = dvec3(radiance) * solidAngle;
        const double weight = luminance(power);
        const dvec3 direction(sine * column[x].x, cosine, sine * column[x].y);
        cells_[cellOfTexel(x, y)] += {power, direction * weight, weight};
      }
    }
  });
  for (const TexelSum& cell : cells_) total_ += cell;
  if (std::max({total_.power.x, total_.power.y, total_.power.z}) >
      std::numeric_limits<float>::max())
    throwInput("probe: the sum of its radiance exceeds the range of a float; scale it down");
}

glm::ivec2 TexelTable::cellAt(const dvec2& uv) const {
  const dvec2 texel = glm::clamp(uv, 0.0, 1.0) * dvec2(mapWidth_, mapHeight_);
  return glm::min(glm::ivec2(texel) / block_, glm::ivec2(width_ - 1, height_ - 1));
}

dvec3 TexelTable::direction(double x, double y) const {
  return *uvToDirection(Mapping::LatLong, uv(x, y));
}

RegionTable::RegionTable(const Image& latLong, RegionMeasure measure)
    : texels_(latLong, kFineCells),
      measure_(measure),
      moments_(longArray<dvec4>(size_t(texels_.width() + 1) * (texels_.height() + 1))),
      lit_(moments_.size()) {
  for (int y = 0; y < texels_.height(); ++y) {
    endIfCancelled();
    const double top = texels_.uv(0, y).y, bottom = texels_.uv(0, y + 1).y;
    // The cells of a row have the same solid angle per area of the map.
    const double factor = measure == RegionMeasure::MapArea
                              ? (bottom - top) / (std::cos(kPiD * top) - std::cos(kPiD * bottom))
                              : 1;
    dvec4 rowMoment(0);
    int32_t rowLit = 0;
    for (int x = 0; x < texels_.width(); ++x) {
      const TexelSum& cell = texels_.at(x, y);
      rowMoment += factor * dvec4(cell.moment, cell.weight);
      rowLit += cell.weight > 0;
      moments_[corner(x + 1, y + 1)] = moments_[corner(x + 1, y)] + rowMoment;
      lit_[corner(x + 1, y + 1)] = lit_[corner(x + 1, y)] + rowLit;
    }
  }
}

dvec4 RegionTable::moment(const Region& r) const {
  return (moments_[corner(r.x1, r.y1)] - moments_[corner(r.x0, r.y1)]) -
         (moments_[corner(r.x1, r.y0)] - moments_[corner(r.x0, r.y0)]);
}

int RegionTable::litCells(const Region& r) const {
  return lit_[corner(r.x1, r.y1)] - lit_[corner(r.x0, r.y1)] - lit_[corner(r.x1, r.y0)] +
         lit_[corner(r.x0, r.y0)];
}

Region RegionTable::trimmed(const Region& r) const {
  const int all = litCells(r);
  Region t = r;
  t.x1 = firstWhere(r.x0, r.x1, [&](int x) { return litCells({r.x0, r.y0, x, r.y1}) == all; });
  t.y1 = firstWhere(r.y0, r.y1, [&](int y) { return litCells({r.x0, r.y0, r.x1, y}) == all; });
  t.x0 = firstWhere(r.x0, r.x1, [&](int x) { return litCells({x, r.y0, r.x1, r.y1}) < all; }) - 1;
  t.y0 = firstWhere(r.y0, r.y1, [&](int y) { return litCells({r.x0, y, r.x1, r.y1}) < all; }) - 1;
  return t;
}

Constellation RegionTable::lights(const std::vector<Region>& regions, LightPlace place) const {
  Constellation lights;
  lights.reserve(regions.size());
  for (const Region& r : regions) {
    endIfCancelled();
    TexelSum sum;
    for (int y = r.y0; y < r.y1; ++y)
      for (int x = r.x0; x < r.x1; ++x) sum += texels_.at(x, y);
    const dvec3 middle =
        *uvToDirection(Mapping::LatLong, 0.5 * (texels_.uv(r.x0, r.y0) + texels_.uv(r.x1, r.y1)));
    lights.push_back(place == LightPlace::Centre ? makeLight(middle, sum.power)
                                                 : lightAt(sum, middle));
  }
  return lights;
}

Partition RegionTable::partition(const Image& latLong, const std::vector<Region>& regions) const {
  Partition partition{int(regions.size()), {}};
  partition.label.assign(size_t(latLong.width) * latLong.height, kNoRegion);
  const int block = texels_.block();
  for (size_t i = 0; i < regions.size(); ++i) {
    const Region& r = regions[i];
    for (int y = r.y0 * block; y < std::min(r.y1 * block, latLong.height); ++y)
      for (int x = r.x0 * block; x < std::min(r.x1 * block, latLong.width); ++x)
        partition.label[size_t(y) * latLong.width + x] = uint16_t(i);
  }
  return partition;
}

std::pair<Region, Region> cutAtColumn(const Region& r, int x) {
  return {{r.x0, r.y0, x, r.y1}, {x, r.y0, r.x1, r.y1}};
}

std::pair<Region, Region> cutAtRow(const Region& r, int y) {
  return {{r.x0, r.y0, r.x1, y}, {r.x0, y, r.x1, r.y1}};
}

std::vector<Region> subdivide(const RegionTable& table, int count,
                              const std::function<double(const Region&)>& priority,
                              const std::function<std::pair<Region, Region>(const Region&)>& cut) {
  std::vector<Region> regions;
  std::priority_queue<std::pair<double, int>> cuttable;  // priority, index in `regions`
  const auto put = [&](int index, const Region& r) {
    regions[index] = table.trimmed(r);
    if (table.litCells(r) > 1) cuttable.push({priority(regions[index]), index});
  };
  const Region whole{0, 0, table.texels().width(), table.texels().height()};
  if (table.litCells(whole) == 0) return {};
  regions.resize(1);
  put(0, whole);
  while (int(regions.size()) < count && !cuttable.empty()) {
    endIfCancelled();
    const int index = cuttable.top().second;
    cuttable.pop();
    const auto [first, second] = cut(regions[index]);
    regions.emplace_back();
    put(index, first);
    put(int(regions.size()) - 1, second);
  }
  return regions;
}

}  // namespace chromeball
