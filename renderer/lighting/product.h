// SPDX-License-Identifier: Apache-2.0
// `product`: directions in proportion to luminance times cosine, so that for a Lambertian surface
// little but visibility is left to chance.
#pragma once

#include "lighting/blocked_field.h"
#include "lighting/strategy.h"
#include "math/cdf.h"

namespace chromeball {

// Normals fall into bins (squares of an octahedral map). For each bin the probe's blocks have a
// distribution of their own, luminance x the mean cosine between block and bin, with a share
// wherever the cosine can be positive; inside its block a direction is chosen by luminance alone.
//   pdf = (luminance's own pdf) x lift(bin, block)
// is known for every direction, so that MIS goes on. Where the surface transmits, half of the
// samples are for the cosine with the normal's opposite. What a specular lobe reflects is left to
// the BSDF's samples.
class Product : public LightingStrategy {
 public:
  explicit Product(const Probe& probe);

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint& point, const vec3& wi) const override;
  Rgb background(const vec3&, const vec3& wi) const override { return probe_.radiance(wi); }
  bool unbiased() const override { return true; }

  // In terms of two numbers in [0, 1), for tests. Black probes give pdf 0.
  DirectionSample sampleDirection(const LightPoint& point, double u, double v) const;

 private:
  // From the mean cosine of each block with the bin's normals.
  void fillBin(int bin, const std::vector<double>& cosines);
  float lift(int bin, int block) const { return lifts_[size_t(bin) * field_.blocks() + block]; }
  float lift(const LightPoint& point, int block) const;

  const Probe& probe_;
  BlockedField field_;
  CdfRows rows_, columns_;    // of blocks: a row a bin, and a row a bin and row of blocks
  std::vector<float> lifts_;  // bins x blocks
};

}  // namespace chromeball
