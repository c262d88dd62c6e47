// `importance`: directions in proportion to the probe's luminance (Pharr and Humphreys; HDRI book,
// 9.6.3), exactly as bright as the bilinear radiance function has it.
#pragma once

#include "lighting/strategy.h"
#include "math/cdf.h"

namespace chromeball {

// The density over the map is the bilinear interpolant of w = luminance x sin(theta) between texel
// centres, as the radiance itself is; a row of cells is chosen, then a cell, then a point in it.
// Density over solid angle = w / (total x jacobian x sin(theta)), which follows the radiance even
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
  Rgb background(const vec3& wi) const override { return probe_.radiance(wi); }
  bool unbiased() const override { return true; }

  // The same in terms of two numbers in [0, 1), for tests. Black probes give density 0.
  DirectionSample sampleDirection(double u, double v) const;
  float density(const vec3& wi) const;

 private:
  struct Weights {
    float w00, w10, w01, w11;
    float at(float s, float t) const {
      return (1 - t) * ((1 - s) * w00 + s * w10) + t * ((1 - s) * w01 + s * w11);
    }
  };
  Weights weights(const Probe::Corners& corners, int row) const;
  double tabulate();

  const Probe& probe_;
  float offset_ = 0;            // luminance taken off by compensation
  std::vector<float> rowSine_;  // sin(theta) of the corner rows
  CdfRows rows_, columns_;
  double total_;
  float scale_;  // 1 / (total x jacobian)
};

}  // namespace chromeball
