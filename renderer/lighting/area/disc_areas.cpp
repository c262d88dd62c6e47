// SPDX-License-Identifier: Apache-2.0
#include "lighting/area/disc_areas.h"

#include <algorithm>
#include <cmath>

#include "probe/mapping.h"

namespace chromeball {
namespace {

constexpr double kMargin = 1e-5;  // radians, for rounding in at()

double angleBetween(const dvec3& a, const dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

DiscAreas::DiscAreas(std::vector<AreaLight> lights) : cells_(size_t(kRows) * kColumns) {
  lights_ = std::move(lights);
  for (const AreaLight& light : lights_) {
    discs_.push_back({Frame(light.direction), float(light.solidAngle / kPiD)});
    found_.push_back({light.radiance(), float(1 / light.solidAngle)});
  }
  listCells();
}

// A disc is listed in a cell if it may reach the circle around the cell's corners.
void DiscAreas::listCells() {
  for (int row = 0; row < kRows; ++row) {
    const auto at = [&](double column, double down) {
      return *uvToDirection(Mapping::LatLong, {column / kColumns, (row + down) / kRows});
    };
    const double cell =
        std::max(angleBetween(at(0.5, 0.5), at(0, 0)), angleBetween(at(0.5, 0.5), at(0, 1)));
    std::vector<dvec3> middles;
    for (int column = 0; column < kColumns; ++column) middles.push_back(at(column + 0.5, 0.5));
    for (size_t i = 0; i < discs_.size(); ++i) {
      const double disc = std::acos(std::max(-1.0, 1 - 0.5 * discs_[i].squaredChord));
      const double nearest = std::cos(std::min(disc + cell + kMargin, kPiD));
      for (int column = 0; column < kColumns; ++column)
        if (glm::dot(middles[column], dvec3(discs_[i].frame.z)) >= nearest)
          cells_[size_t(row) * kColumns + column].push_back(uint16_t(i));
    }
  }
}

const std::vector<uint16_t>& DiscAreas::cellOf(const vec3& wi) const {
  const float u = 0.5f + atan2Turns(wi.x, -wi.z);
  const float v = 2 * atan2Turns(std::sqrt(wi.x * wi.x + wi.z * wi.z), wi.y);
  // Clamped on both sides: a NaN direction must not read outside the table.
  const int column = std::clamp(int(u * kColumns), 0, kColumns - 1);
  const int row = std::clamp(int(v * kRows), 0, kRows - 1);
  return cells_[size_t(row) * kColumns + column];
}

LightAreas::Found DiscAreas::at(const vec3& wi) const {
  Found found;
  for (const uint16_t i : cellOf(wi))
    if (discs_[i].contains(wi)) {
      found.radiance += found_[i].radiance;
      found.density += found_[i].density;
    }
  return found;
}

void DiscAreas::split(const vec3& wi, std::span<Rgb> radiances) const {
  for (const uint16_t i : cellOf(wi))
    if (discs_[i].contains(wi)) radiances[i] += found_[i].radiance;
}

LightAreas::Sample DiscAreas::sample(size_t light, double u, double v) const {
  const vec3 direction = discs_[light].direction(float(u), float(v));
  return {direction, at(direction)};
}

}  // namespace chromeball
