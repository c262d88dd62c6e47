// SPDX-License-Identifier: Apache-2.0
// Wraps a strategy that replaces the probe by lights: the camera and mirrors see the lights instead
// of the probe, as in the HDRI book, Figs. 9.31 and 9.35.
#pragma once

#include <memory>

#include "lighting/constellation/directional_light.h"
#include "lighting/light_areas.h"
#include "lighting/light_source.h"
#include "math/rotation.h"

namespace chromeball {

// Each light is seen as a disc with its energy and its solid angle, but at least
// kShownDegrees in diameter, before `ambient` (black, where none was fitted).
class ShownLights : public LightSource {
 public:
  static constexpr double kShownDegrees = 1;

  ShownLights(std::unique_ptr<LightSource> strategy, std::vector<AreaLight> lights,
              const Rgb& ambient = Rgb(0));

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override {
    strategy_->sample(point, sampler, out);
  }
  Escaped escaped(const LightPoint& point, const vec3& wi) const override {
    return strategy_->escaped(point, wi);
  }
  Rgb background(const vec3&, const vec3& wi) const override {
    return ambient_ + discs_.at(wi).radiance;
  }
  float mirrorAlpha() const override { return strategy_->mirrorAlpha(); }
  bool unbiased() const override { return strategy_->unbiased(); }
  std::vector<std::string> groups() const override { return strategy_->groups(); }
  void splitEscaped(const LightPoint& point, const vec3& wi,
                    std::span<Rgb> radiances) const override {
    strategy_->splitEscaped(point, wi, radiances);
  }
  // The last group is what the camera and mirrors see.
  void splitBackground(const vec3& origin, const vec3& wi,
                       std::span<Rgb> radiances) const override {
    radiances.back() += background(origin, wi);
  }

 private:
  std::unique_ptr<LightSource> strategy_;
  DiscAreas discs_;
  Rgb ambient_;
};

// Lights of no extent as lights to show, turned.
std::vector<AreaLight> shownLights(const Constellation& lights, const Rotation& rotation);

}  // namespace chromeball
