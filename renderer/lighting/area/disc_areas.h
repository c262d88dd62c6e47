// SPDX-License-Identifier: Apache-2.0
// Area lights that are discs, which may overlap.
#pragma once

#include "lighting/area/light_areas.h"
#include "math/spherical_cap.h"

namespace chromeball {

class DiscAreas : public LightAreas {
 public:
  // Each light becomes the disc around its direction with its solid angle. At most 65535 lights.
  explicit DiscAreas(std::vector<AreaLight> lights);

  Found at(const vec3& wi) const override;
  void split(const vec3& wi, std::span<Rgb> radiances) const override;
  Sample sample(size_t light, double u, double v) const override;

 private:
  static constexpr int kRows = 64, kColumns = 2 * kRows;

  void listCells();
  const std::vector<uint16_t>& cellOf(const vec3& wi) const;

  std::vector<SphericalCap> discs_;
  std::vector<Found> found_;  // in each disc, without the others
  std::vector<std::vector<uint16_t>>
      cells_;  // the discs that may touch each cell of a lat-long map
};

}  // namespace chromeball
