// SPDX-License-Identifier: Apache-2.0
#include "lighting/constellation/texel_table.h"

#include <algorithm>
#include <limits>

#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "probe/mapping.h"
#include "probe/solid_angle.h"

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

}  // namespace chromeball
