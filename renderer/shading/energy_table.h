// SPDX-License-Identifier: Apache-2.0
// How much light a rough specular surface reflects in one bounce: what energy compensation needs.
#pragma once

#include <vector>

namespace chromeball {

// Single-scattering GGX albedo under Schlick's Fresnel, which is linear in F0 and F90:
//   albedo(mu) = F0 a(mu) + F90 b(mu),   mu the cosine of the viewing angle.
// With F0 = F90 = 1 it falls short of 1 by what microfacets scatter again.
struct SpecularAlbedo {
  float a, b;
};

class EnergyTable {
 public:
  // Tabulated by quadrature once a process, on first use, which must not be inside a parallel loop.
  static const EnergyTable& get();

  // One roughness (of perceptual roughness r = sqrt(alpha)), ready for any angle.
  class Row {
   public:
    SpecularAlbedo at(float mu) const;
    SpecularAlbedo average() const { return average_; }  // cosine-weighted: 2 int albedo mu dmu

   private:
    friend class EnergyTable;
    const SpecularAlbedo *low_, *high_;
    float blend_;
    SpecularAlbedo average_;
  };
  Row row(float roughness) const;

 private:
  EnergyTable();
  std::vector<SpecularAlbedo> cells_;     // kRoughnesses x kAngles
  std::vector<SpecularAlbedo> averages_;  // kRoughnesses
};

}  // namespace chromeball
