// SPDX-License-Identifier: Apache-2.0
// Emissive triangles as lights.
#pragma once

#include <vector>

#include "math/cdf.h"
#include "scene/scene.h"

namespace chromeball {

// Every triangle whose material emits, chosen by power (mean emitted luminance x mean alpha x area)
// and sampled uniformly over its area. The pdf over area is then the same for all points of a
// material: its mean luminance x alpha / total.
class Emitters {
 public:
  // Null if nothing emits.
  static std::unique_ptr<Emitters> make(const Scene& scene);

  struct Point {
    uint32_t instance, triangle;  // as in Hit
    vec2 barycentric;
    vec3 position;
  };
  // `choice` in [0, 1) needs the 53 bits of PixelSampler::getFine1(), so that the weakest of a
  // million triangles can be chosen.
  Point sample(double choice, float v) const;

  // Pdf over solid angle of sampling a point of `material` at a distance of `distance` metres, with
  // cosine `cosine` (> 0) at the emitter.
  float pdf(int material, float distance, float cosine) const {
    return areaPdf_[material] * distance * distance / cosine;
  }

 private:
  struct EmissiveTriangle {
    uint32_t instance, triangle;
    vec3 p0, p1, p2;
  };
  Emitters(std::vector<EmissiveTriangle> triangles, const std::vector<double>& powers,
           const std::vector<double>& radiances);

  std::vector<EmissiveTriangle> triangles_;
  std::vector<float> areaPdf_;  // by material, 1/m^2; 0 where it does not emit
  CdfRows choice_;
};

}  // namespace chromeball
