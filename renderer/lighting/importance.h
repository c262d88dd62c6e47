// SPDX-License-Identifier: Apache-2.0
// `importance`: directions in proportion to the probe's luminance (Pharr and Humphreys; HDRI book,
// 9.6.3), exactly as bright as the bilinear radiance function has it.
#pragma once

#include "lighting/luminance_field.h"
#include "lighting/strategy.h"
#include "math/cdf.h"

namespace chromeball {

// The pdf over the map is the bilinear interpolant of w = luminance x sin(theta) between texel
// centres, as the radiance itself is; a row of cells is chosen, then a cell, then a point in it.
// Pdf over solid angle = w / (total x jacobian x sin(theta)), which follows the radiance even
// inside a texel, and is positive wherever the radiance is.
//
// MIS compensation (Karlik et al. 2019): w becomes max(luminance - mean, 0) x sin(theta), leaving
// to the BSDF's samples what they find as well. Only for use with MIS; falls back to the plain
// table where next to nothing is left.
class Importance : public LightingStrategy {
 public:
  Importance(const Probe& probe, bool compensated);

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint& point, const vec3& wi) const override;
  Rgb background(const vec3&, const vec3& wi) const override { return probe_.radiance(wi); }
  bool unbiased() const override { return true; }

  // The same in terms of two numbers in [0, 1), for tests. Black probes give pdf 0.
  DirectionSample sampleDirection(double u, double v) const;
  float pdf(const vec3& wi) const;

 private:
  double tabulate();

  const Probe& probe_;
  LuminanceField field_;
  CdfRows rows_, columns_;
  double total_;
  float scale_;  // pdf over solid angle for each unit of the field's weight
};

}  // namespace chromeball
