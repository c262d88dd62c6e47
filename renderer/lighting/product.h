// SPDX-License-Identifier: Apache-2.0
// `product`: directions with pdf proportional to luminance x cosine, so that on a Lambertian
// surface most of the remaining variance comes from visibility.
#pragma once

#include "lighting/luminance_field.h"
#include "lighting/probe_light.h"
#include "math/cdf.h"

namespace chromeball {

// Normals are binned (squares of an octahedral map). Each bin has a distribution over the blocks of
// the probe: luminance x the mean cosine between block and bin, positive wherever the cosine can
// be. Within a block the pdf is proportional to luminance. So for every direction the pdf is known,
// as MIS requires:
//   pdf = (pdf proportional to luminance) x pdfRatio(bin, block).
// On a transmissive surface half of the samples use the opposite normal. The pdf does not follow
// specular lobes; BSDF samples do.
class Product : public ProbeLight {
 public:
  explicit Product(const Probe& probe);

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint& point, const vec3& wi) const override;
  bool takesOneSample() const override { return true; }

  // The sample from two numbers in [0, 1); pdf 0 for a black probe.
  DirectionSample sampleDirection(const LightPoint& point, double u, double v) const;

 private:
  // `cosines`: the mean cosine of each block with the bin's normals.
  void fillBin(int bin, const std::vector<double>& cosines);
  float pdfRatio(int bin, int block) const {
    return pdfRatios_[size_t(bin) * field_.blocks() + block];
  }
  float pdfRatio(const LightPoint& point, int block) const;

  BlockedField field_;
  CdfRows rows_;                  // of blocks, for each bin
  CdfRows columns_;               // of blocks, for each bin and row of blocks
  std::vector<float> pdfRatios_;  // bins x blocks
};

}  // namespace chromeball
