// SPDX-License-Identifier: Apache-2.0
// Emissive triangles as lights.
#pragma once

#include <memory>
#include <vector>

#include "lighting/light_source.h"
#include "math/cdf.h"
#include "scene/scene.h"

namespace chromeball {

// Every triangle whose material emits, chosen by power (mean emitted luminance x mean alpha x area)
// and sampled uniformly over its area. The pdf over area is then the same for all points of a
// material: its mean luminance x alpha / total.
//
// While the shutter is open, a triangle is chosen by the area that it has when it opens.
//
// A call of sample() gives one sample. Its radiance is the point's radiance times its alpha, the
// probability that a BSDF-sampled ray hits it.
class Emitters : public LightSource {
 public:
  // Null if nothing emits. The scene must outlive this.
  static std::unique_ptr<Emitters> make(const Scene& scene);

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  float pdfOfHit(const LightPoint& point, const Surface& surface,
                 const Instance& instance) const override;
  std::vector<std::string> groups() const override { return {}; }

  struct Point {
    uint32_t instance, triangle;  // as in Hit
    vec2 barycentric;
    vec3 position;
  };
  // `choice` in [0, 1) needs the 53 bits of PixelSampler::getFine1(), so that the weakest of a
  // million triangles can be chosen.
  Point choose(double choice, float v) const;

  // Pdf over solid angle of sampling a point of `material` at a distance of `distance` metres, with
  // cosine `cosine` (> 0) at the emitter.
  float pdf(int material, float distance, float cosine) const {
    return areaPdf_[material] * distance * distance / cosine;
  }

 private:
  vec3 placeOf(const Point& point, const Instance& instance, float time) const;
  // The ratio of the area by which a triangle was chosen to its area at the surface's time.
  float areaRatio(const Surface& surface, const Instance& instance) const;
  struct EmissiveTriangle {
    uint32_t instance, triangle;
    vec3 p0, p1, p2;
  };
  Emitters(const Scene& scene, std::vector<EmissiveTriangle> triangles,
           const std::vector<double>& powers, const std::vector<double>& radiances);

  const Scene& scene_;
  std::vector<EmissiveTriangle> triangles_;
  std::vector<float> areaPdf_;  // by material, 1/m^2; 0 where it does not emit
  CdfRows choice_;
};

}  // namespace chromeball
