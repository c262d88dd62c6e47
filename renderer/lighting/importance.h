// SPDX-License-Identifier: Apache-2.0
// `importance`: directions with pdf proportional to the probe's luminance (Pharr and Humphreys,
// "Infinite Area Light Source with Importance Sampling", 2004; HDRI book, section 9.6.3).
#pragma once

#include "lighting/luminance_field.h"
#include "lighting/probe_light.h"
#include "math/cdf.h"

namespace chromeball {

// Over the map the pdf is proportional to w, the bilinear interpolant of luminance x sin(theta)
// between texel centres (luminance_field.h). A row of cells is sampled, then a cell, then a point
// in it. The pdf over solid angle is w / (total x jacobian x sin(theta)): continuous, and positive
// wherever the radiance is.
//
// MIS compensation (Karlik et al., "MIS Compensation: Optimizing Sampling Techniques in Multiple
// Importance Sampling", 2019): w becomes max(luminance - mean, 0) x sin(theta), because BSDF
// samples cover the rest. Only valid with MIS. The plain w is used if the total of the compensated
// w is almost 0.
class Importance : public ProbeLight {
 public:
  Importance(const Probe& probe, bool compensated);

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint& point, const vec3& wi) const override;
  bool sampleMany(std::span<const glm::uvec2> numbers,
                  std::span<DirectionSample> out) const override;
  void escapedMany(std::span<const Escape> rays, std::span<Escaped> out) const override;
  void backgroundMany(std::span<const Sight> rays, std::span<Rgb> out) const override;
  void sampleArrays(std::span<const uint32_t> u, const uint32_t* v,
                    LightArrays& out) const override;
  void escapedArrays(const RayArrays& rays, size_t count, LightArrays& out) const override;
  void backgroundArrays(const RayArrays& rays, size_t count, LightArrays& out) const override;

  // The sample from two numbers in [0, 1), of which 32 bits count, and its pdf over solid angle; 0
  // for a black probe.
  DirectionSample sampleDirection(double u, double v) const;
  float pdf(const vec3& wi) const;

  const LuminanceField& field() const { return field_; }

 private:
  double tabulate();

  LuminanceField field_;
  FractionCdfRows rows_, columns_;  // of cells by v, and the cells of each row by u
  double total_;
  float scale_;  // factor from the field's weight to the pdf over solid angle
};

}  // namespace chromeball
