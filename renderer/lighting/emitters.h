// SPDX-License-Identifier: Apache-2.0
// Emissive triangles as lights.
#pragma once

#include <memory>
#include <vector>

#include "lighting/light_source.h"
#include "math/cdf.h"
#include "scene/scene.h"

namespace chromeball {

// Every triangle that emits, chosen by power (its mean emitted luminance x mean alpha of the
// material x area) and sampled uniformly over its area. The pdf over area is then its luminance x
// alpha / total. Of a texture, the mean is an estimate (emission_map.h); triangles all of whose
// texels are black are never chosen.
//
// While the shutter is open, a triangle is chosen by the area that it has when it opens.
//
// A call of sample() gives one sample. Its radiance is the point's radiance times its alpha, the
// probability that a BSDF-sampled ray hits it.
class Emitters : public LightSource {
 public:
  // What one takes while they are made: its corners, power, and place in the distribution.
  static constexpr size_t kBytesPerTriangle = 68;

  // Null if nothing emits. The scene must outlive this.
  static std::unique_ptr<Emitters> make(const Scene& scene);

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  float pdfOfHit(const LightPoint& point, const Surface& surface, uint32_t instance,
                 uint32_t triangle) const override;
  bool knowsAsBlack(uint32_t instance, uint32_t triangle) const override {
    return areaPdf(instance, triangle) == 0;
  }
  std::vector<std::string> groups() const override { return {}; }

  struct Point {
    uint32_t instance, triangle;  // as in Hit
    vec2 barycentric;
    vec3 position;
  };
  // `choice` in [0, 1) needs the 53 bits of PixelSampler::getFine1(), so that the weakest of a
  // million triangles can be chosen.
  Point choose(double choice, float v) const;

  // Pdf over solid angle of sampling a point of a triangle at a distance of `distance` metres, with
  // cosine `cosine` (> 0) at the emitter. 0 of triangles that do not emit.
  float pdf(size_t instance, size_t triangle, float distance, float cosine) const {
    return areaPdf(instance, triangle) * distance * distance / cosine;
  }

 private:
  vec3 placeOf(const Point& point, const Instance& instance, float time) const;
  // 1/m^2; 0 only where nothing emits.
  float areaPdf(size_t instance, size_t triangle) const {
    const Densities& of = densities_[instance];
    return areaPdfs_[of.first + (of.areByTriangle ? triangle : 0)];
  }
  // The ratio of the area by which a triangle was chosen to its area at the surface's time.
  float areaRatio(const Surface& surface, const Instance& instance) const;
  struct EmissiveTriangle {
    uint32_t instance, triangle;
    vec3 p0, p1, p2;
  };
  // Of an instance, in areaPdfs_: one number, or one for each triangle where they differ.
  struct Densities {
    size_t first;
    bool areByTriangle;
  };
  struct Found;
  Emitters(const Scene& scene, Found found);

  const Scene& scene_;
  std::vector<EmissiveTriangle> triangles_;
  std::vector<Densities> densities_;
  std::vector<float> areaPdfs_;
  CdfRows choice_;
};

}  // namespace chromeball
