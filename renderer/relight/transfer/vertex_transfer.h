// SPDX-License-Identifier: Apache-2.0
// Precomputed radiance transfer of diffuse surfaces: what each function of a basis of light makes
// at points of a scene (Sloan, Kautz and Snyder 2002, section 5; HDRI book, section 9.9.2).
#pragma once

#include "bake/bake_points.h"
#include "base/progress.h"
#include "film/invalid.h"
#include "relight/transfer/light_basis.h"
#include "transport/world.h"

namespace chromeball {

struct TransferSettings {
  uint32_t samples = 1024;  // paths of each point
  uint64_t seed = 0;
  int maxDepth = 8;  // as PathSettings, from 1: direct light with shadows alone
};

struct VertexTransfer {
  size_t count = 0;         // values of each point
  std::vector<Rgb> values;  // point by point
  // What the scene's own lamps and emitting surfaces make; empty if it has none.
  std::vector<Rgb> own;
  std::vector<uint8_t> isBuried;  // inside a body (PointLight::isBuried): values are 0
  InvalidSamples invalid;         // at the points' x and y

  std::span<const Rgb> of(size_t point) const {
    return std::span(values).subspan(point * count, count);
  }
};

// Values are irradiance / pi per unit of each function: the radiance of a white Lambertian surface,
// as light that shines on it, with shadows and light that other surfaces reflect to it. For
// harmonics and an open point with normal n, value k is A_l / pi Y_k(n), with the A_l of
// shIrradiance(), continued to higher bands (Ramamoorthi and Hanrahan 2001, eq. 8). `meshes`:
// of all instances. The result depends on points, samples and seed only.
VertexTransfer estimateTransfer(const World& world, const std::vector<PlacedMesh>& meshes,
                                const std::vector<BakePoint>& points, const LightBasis& basis,
                                const TransferSettings& settings, const Progress& progress);

}  // namespace chromeball
