// SPDX-License-Identifier: Apache-2.0
// Directional lights that replace the probe: constellations and fitted lights.
#pragma once

#include <memory>

#include "lighting/area_lights.h"
#include "lighting/constellation/directional_light.h"
#include "math/rotation.h"

namespace chromeball {

// Broad lobes are lit by the lights and by a constant `ambient` radiance from all directions, and
// not by the probe. The camera, mirrors and lobes narrower than mirrorAlpha() see the probe and not
// the lights (HDRI book, section 9.6.2). So no energy is counted twice.
//
// The first hit uses all lights. Later hits choose kLater lights, with probability proportional to
// irradiance x cosine (x BSDF for layered BSDFs, which may transmit light), and divide by the
// probability: less noise in the same time than with all lights.
class DeltaLights : public ProbeLight {
 public:
  static constexpr int kLater = 4;

  // `lights` and `ambient` replace the unrotated map of `probe`; the probe's rotation is applied to
  // the lights.
  DeltaLights(const Probe& probe, const Constellation& lights, const Rgb& ambient = Rgb(0));

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint&, const vec3&) const override { return {ambient_, 0}; }
  // N lights have a mean solid angle of 4 pi / N each. A narrower lobe, 4 pi alpha^2 < 4 pi / N,
  // would reflect the lights as separate highlights.
  float mirrorAlpha() const override {
    return lights_.empty() ? 0 : 1 / std::sqrt(float(lights_.size()));
  }
  bool unbiased() const override { return false; }
  // The lights by number, in the order of the constellation; then what the camera and mirrors see.
  std::vector<std::string> groups() const override;
  void splitEscaped(const LightPoint&, const vec3&, std::span<Rgb> radiances) const override {
    radiances[count_] += ambient_;
  }

 private:
  Rgb ambient_;
  size_t count_;                         // of the constellation's lights
  std::vector<DirectionSample> lights_;  // without black ones
};

// Wraps a strategy that replaces the probe by lights: the camera and mirrors see the lights instead
// of the probe, as in the HDRI book, Figs. 9.31 and 9.35.

// Each light is seen as a disc with its energy and its solid angle, but at least
// kShownDegrees in diameter, before `ambient` (black, where none was fitted).
class ShownLights : public WrappedLight {
 public:
  static constexpr double kShownDegrees = 1;

  ShownLights(std::unique_ptr<LightSource> strategy, std::vector<AreaLight> lights,
              const Rgb& ambient = Rgb(0));

  Rgb background(const vec3&, const vec3& wi) const override {
    return ambient_ + discs_.at(wi).radiance;
  }

 private:
  DiscAreas discs_;
  Rgb ambient_;
};

// Turns lights of no extent into lights to show, rotated.
std::vector<AreaLight> shownLights(const Constellation& lights, const Rotation& rotation);

}  // namespace chromeball
