// How much light a rough boundary between dielectrics scatters in one bounce: what Glass's energy
// compensation needs.
#pragma once

#include <vector>

namespace chromeball {

// Albedo, reflection and refraction together, of GGX microfacets that lose nothing themselves;
// below 1 by what they mask and would scatter again.
class GlassTable {
 public:
  // Tabulated by quadrature once a process, on first use, which must not be inside a parallel loop.
  static const GlassTable& get();

  // `mu`: cosine of the viewing angle; `eta` as in dielectric.h; perceptual roughness.
  float albedo(float mu, float roughness, float eta) const;

 private:
  GlassTable();
  std::vector<float> cells_;  // kEtas x kRoughnesses x kAngles
};

}  // namespace chromeball
