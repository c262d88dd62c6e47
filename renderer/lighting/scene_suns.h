// SPDX-License-Identifier: Apache-2.0
// Wraps any strategy: adds the suns that a scene has besides its probe (HDRI book, sections 9.3.5
// and 9.6.1).
#pragma once

#include <memory>

#include "lighting/sky_discs.h"
#include "lighting/strategy.h"
#include "scene/lamp.h"

namespace chromeball {

// Takes the samples of the strategy, and those of the discs. Radiances and pdfs of both are added
// in each direction, so that all samples are combined by the balance heuristic. The camera and
// mirrors see the visible discs.
class SceneSuns : public LightingStrategy {
 public:
  SceneSuns(std::unique_ptr<LightingStrategy> strategy, const std::vector<SunLamp>& suns);

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint& point, const vec3& wi) const override;
  Rgb background(const vec3& origin, const vec3& wi) const override {
    return strategy_->background(origin, wi) + visible_.at(wi).radiance;
  }
  float mirrorAlpha() const override { return strategy_->mirrorAlpha(); }
  bool unbiased() const override { return strategy_->unbiased(); }

 private:
  std::unique_ptr<LightingStrategy> strategy_;
  SkyDiscs all_, visible_;
};

}  // namespace chromeball
