// SPDX-License-Identifier: Apache-2.0
#include "shading/anisotropic_table.h"

#include <tbb/parallel_for.h>

#include <array>

#include "shading/albedo_quadrature.h"

namespace chromeball {
namespace {

constexpr std::array<int, 4> kNodes = {16, 9, 16, 7};  // roughness, strength, angle, azimuth

// Node i along dimension d as a share of the way; roughness and angle crowd towards 0, as in
// albedo_quadrature.h.
float node(int d, int i) { return float(i) / float(kNodes[size_t(d)] - 1); }

}  // namespace

vec2 anisotropicAlpha(float roughness, float strength) {
  constexpr float kMin = 1e-3f;  // a groove narrower than this is as good as a scratch's line
  const float alpha = std::max(roughness * roughness, kMin);
  return {glm::mix(alpha, 1.0f, strength * strength), alpha};
}

AnisotropicTable::AnisotropicTable()
    : cells_(size_t(kNodes[0] * kNodes[1] * kNodes[2] * kNodes[3])) {
  const std::vector<vec2> points = quadraturePoints(512);
  tbb::parallel_for(0, kNodes[0] * kNodes[1], [&](int row) {
    const float r = node(0, row / kNodes[1]);
    const vec2 alpha = anisotropicAlpha(r * r, node(1, row % kNodes[1]));
    for (int i = 0; i < kNodes[2]; ++i)
      for (int j = 0; j < kNodes[3]; ++j) {
        const float mu = std::max(node(2, i) * node(2, i), 1e-4f);
        const vec3 wo = unitVector(mu, 0.25f * node(3, j));
        cells_[size_t((row * kNodes[2] + i) * kNodes[3] + j)] = specularAlbedo(wo, alpha, points);
      }
  });
}

const AnisotropicTable& AnisotropicTable::get() {
  static const AnisotropicTable table;
  return table;
}

SpecularAlbedo AnisotropicTable::albedo(const vec3& wo, float roughness, float strength) const {
  const float turns = atan2Turns(std::fabs(wo.y), std::fabs(wo.x));
  const std::array<float, 4> at = {std::sqrt(roughness), strength, std::sqrt(wo.z), 4 * turns};
  std::array<int, 4> low;
  std::array<float, 4> blend;
  for (size_t d = 0; d < 4; ++d) {
    const float x = glm::clamp(at[d], 0.0f, 1.0f) * float(kNodes[d] - 1);
    low[d] = std::min(int(x), kNodes[d] - 2);
    blend[d] = x - float(low[d]);
  }
  SpecularAlbedo sum{0, 0};
  for (int corner = 0; corner < 16; ++corner) {
    int cell = 0;
    float weight = 1;
    for (size_t d = 0; d < 4; ++d) {
      const int up = corner >> d & 1;
      cell = cell * kNodes[d] + low[d] + up;
      weight *= up ? blend[d] : 1 - blend[d];
    }
    sum.a += weight * cells_[size_t(cell)].a;
    sum.b += weight * cells_[size_t(cell)].b;
  }
  return sum;
}

}  // namespace chromeball
