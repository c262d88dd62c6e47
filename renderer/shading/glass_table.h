// SPDX-License-Identifier: Apache-2.0
// Albedo of a rough boundary between dielectrics in one bounce, for energy compensation.
#pragma once

#include "math/grid_table.h"

namespace chromeball {

// Albedo in one bounce, reflection plus refraction, of GGX microfacets without absorption. It is
// below 1 by the masked light, which would be scattered again. The facets reflect all light above
// the critical angle, and below it a fraction that is affine in Fresnel's reflectance F:
//   reflectance = offset + slope F,   albedo = plain + offset a + slope b.
struct GlassAlbedo {
  float plain, a, b;
  float at(float offset, float slope) const { return plain + offset * a + slope * b; }

  friend GlassAlbedo mix(const GlassAlbedo& x, const GlassAlbedo& y, float t) {
    return {glm::mix(x.plain, y.plain, t), glm::mix(x.a, y.a, t), glm::mix(x.b, y.b, t)};
  }
};

// Over the index of refraction, perceptual roughness and the cosine of the viewing angle.
// 49 x 20 x 40 nodes, 460 KB; takes 0.33 s of one core to build, on all cores.
class GlassTable {
 public:
  GlassTable();

  // `mu`: cosine of the viewing angle; `eta` as in fresnel.h; perceptual roughness in [0, 1].
  GlassAlbedo albedo(float mu, float roughness, float eta) const;

 private:
  static constexpr int kEtas = 49, kRoughnesses = 20, kAngles = 40;
  GridTable<GlassAlbedo, kEtas, kRoughnesses, kAngles> grid_;
};

}  // namespace chromeball
