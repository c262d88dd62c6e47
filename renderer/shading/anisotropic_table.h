// SPDX-License-Identifier: Apache-2.0
// How much light brushed metal reflects in one bounce: EnergyTable's sister for anisotropic GGX.
#pragma once

#include <vector>

#include "math/vec.h"
#include "shading/energy_table.h"

namespace chromeball {

// Widths along and across the tangent (KHR_materials_anisotropy), for perceptual roughness and
// strength in [0, 1].
vec2 anisotropicAlpha(float roughness, float strength);

class AnisotropicTable {
 public:
  // Tabulated by quadrature once a process, on first use, which must not be inside a parallel loop.
  static const AnisotropicTable& get();

  // Albedo for the viewing direction `wo`, the tangent along x.
  SpecularAlbedo albedo(const vec3& wo, float roughness, float strength) const;

 private:
  AnisotropicTable();
  std::vector<SpecularAlbedo> cells_;  // kRoughnesses x kStrengths x kAngles x kAzimuths
};

}  // namespace chromeball
