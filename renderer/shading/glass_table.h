// SPDX-License-Identifier: Apache-2.0
// How much light a rough boundary between dielectrics scatters in one bounce: what Glass's energy
// compensation needs.
#pragma once

#include <vector>

namespace chromeball {

// Albedo in one bounce, reflection and refraction together, of GGX microfacets that lose nothing
// themselves; below 1 by what they mask and would scatter again. They reflect all light beyond the
// critical angle, and before it a share that is an affine function of Fresnel's, F:
//   reflectance = offset + slope F,   albedo = plain + offset a + slope b.
struct GlassAlbedo {
  float plain, a, b;
  float at(float offset, float slope) const { return plain + offset * a + slope * b; }
};

class GlassTable {
 public:
  // Tabulated by quadrature once a process, on first use, which must not be inside a parallel loop.
  static const GlassTable& get();

  // `mu`: cosine of the viewing angle; `eta` as in dielectric.h; perceptual roughness.
  GlassAlbedo albedo(float mu, float roughness, float eta) const;

 private:
  GlassTable();
  std::vector<GlassAlbedo> cells_;  // kEtas x kRoughnesses x kAngles
};

}  // namespace chromeball
