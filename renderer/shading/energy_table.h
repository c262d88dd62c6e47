// SPDX-License-Identifier: Apache-2.0
// Albedo of isotropic GGX reflection in one bounce, for energy compensation.
#pragma once

#include "math/grid_table.h"
#include "shading/specular_albedo.h"

namespace chromeball {

// Over perceptual roughness r = sqrt(alpha) and the cosine mu of the viewing angle. 32 x 64 nodes,
// 16 KB; takes 0.12 s of one core to build, on all cores.
class EnergyTable {
  static constexpr int kRoughnesses = 32, kAngles = 64;
  using Grid = GridTable<SpecularAlbedo, kRoughnesses, kAngles>;

 public:
  EnergyTable();

  // One roughness, ready for any angle. The table must outlive it.
  class Row {
   public:
    SpecularAlbedo at(float mu) const;
    SpecularAlbedo average() const { return average_; }  // cosine-weighted: 2 int E(mu) mu dmu

   private:
    friend class EnergyTable;
    Row(const Grid& grid, GridPosition roughness, const SpecularAlbedo& average)
        : grid_(&grid), roughness_(roughness), average_(average) {}

    const Grid* grid_;
    GridPosition roughness_;
    SpecularAlbedo average_;
  };
  Row row(float roughness) const;

 private:
  Grid grid_;
  GridTable<SpecularAlbedo, kRoughnesses> averages_;
};

}  // namespace chromeball
