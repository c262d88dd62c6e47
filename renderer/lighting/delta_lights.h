// SPDX-License-Identifier: Apache-2.0
// Directional lights in the probe's place: constellations and fitted lights.
#pragma once

#include "lighting/constellation/directional_light.h"
#include "lighting/strategy.h"

namespace chromeball {

// Matte and glossy lobes are lit by the lights (and a constant `ambient` radiance from everywhere),
// and see nothing of the probe itself; the camera and mirrors, perfect or nearly so, see the probe
// and none of the lights (HDRI book, 9.6.2). So each energy counts once.
//
// The first hit is lit by all lights. Later ones get kLater choices among them in proportion to
// irradiance x cosine, or x BSDF where light may come from behind, and raised by as much: less
// noise for the time than all of them.
class DeltaLights : public LightingStrategy {
 public:
  static constexpr int kLater = 4;

  // `lights` and `ambient` stand for the map that `probe` was made of; the lights turn with its
  // rotation.
  DeltaLights(const Probe& probe, const Constellation& lights, const Rgb& ambient = Rgb(0));

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint&, const vec3&) const override { return {ambient_, 0}; }
  Rgb background(const vec3&, const vec3& wi) const override { return probe_.radiance(wi); }
  // A lobe narrower than the share of the sphere that a light stands for, 4 pi alpha^2 < 4 pi / N,
  // would show the lights one by one.
  float mirrorAlpha() const override {
    return lights_.empty() ? 0 : 1 / std::sqrt(float(lights_.size()));
  }
  bool unbiased() const override { return false; }

 private:
  const Probe& probe_;
  Rgb ambient_;
  std::vector<DirectionSample> lights_;
};

}  // namespace chromeball
