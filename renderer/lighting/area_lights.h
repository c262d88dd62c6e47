// SPDX-License-Identifier: Apache-2.0
// Area lights that replace the probe: constellations without the aliasing of delta lights.
#pragma once

#include <memory>

#include "lighting/light_areas.h"
#include "lighting/light_source.h"
#include "math/cdf.h"
#include "probe/probe.h"

namespace chromeball {

// Broad lobes are lit by the lights, in place of the probe; the camera, mirrors and lobes narrower
// than mirrorAlpha() see the probe, as with DeltaLights. The pdf of light samples is the sum over
// all samples of a call, and BSDF samples find the lights too.
//
// The first hit samples one direction in each light, uniform over its solid angle: Kollig and
// Keller's stratification with the regions' average colours (2003; HDRI book, section 9.6.2). Later
// hits sample kLater lights, chosen with probability proportional to power.
class AreaLights : public LightSource {
 public:
  static constexpr int kLater = 4;

  AreaLights(const Probe& probe, std::unique_ptr<const LightAreas> areas);

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint& point, const vec3& wi) const override;
  Rgb background(const vec3&, const vec3& wi) const override { return probe_.radiance(wi); }
  float mirrorAlpha() const override;
  bool unbiased() const override { return false; }
  // The lights by number; then what the camera and mirrors see.
  std::vector<std::string> groups() const override;
  void splitEscaped(const LightPoint&, const vec3& wi, std::span<Rgb> radiances) const override {
    areas_->split(wi, radiances);
  }
  void splitBackground(const vec3& origin, const vec3& wi,
                       std::span<Rgb> radiances) const override {
    radiances.back() += background(origin, wi);
  }

 private:
  bool samplesAll(int depth) const { return depth == 0 || int(areas_->lights().size()) <= kLater; }
  // The pdf of the samples at a hit, over solid angle.
  float pdf(const LightAreas::Found& found, int depth) const;

  const Probe& probe_;
  std::unique_ptr<const LightAreas> areas_;
  CdfRows choice_;    // of a light by power
  double power_ = 0;  // luminance of all lights
};

}  // namespace chromeball
