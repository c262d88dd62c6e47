// SPDX-License-Identifier: Apache-2.0
// Wraps a strategy that samples the whole probe: tells its suns and the rest of it apart, as light
// groups.
#pragma once

#include <memory>

#include "lighting/light_source.h"
#include "probe/probe.h"
#include "probe/sun_extraction.h"

namespace chromeball {

// Samples and radiances are the strategy's.
class SplitProbe : public LightSource {
 public:
  SplitProbe(std::unique_ptr<LightSource> strategy, const Probe& probe);

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override {
    strategy_->sample(point, sampler, out);
  }
  Escaped escaped(const LightPoint& point, const vec3& wi) const override {
    return strategy_->escaped(point, wi);
  }
  void escapedMany(std::span<const Escape> rays, std::span<Escaped> out) const override {
    strategy_->escapedMany(rays, out);
  }
  bool sampleMany(std::span<const glm::uvec2> numbers,
                  std::span<DirectionSample> out) const override {
    return strategy_->sampleMany(numbers, out);
  }
  bool takesOneSample() const override { return strategy_->takesOneSample(); }
  Rgb background(const vec3& origin, const vec3& wi) const override {
    return strategy_->background(origin, wi);
  }
  float mirrorAlpha() const override { return strategy_->mirrorAlpha(); }
  bool unbiased() const override { return strategy_->unbiased(); }

  std::vector<std::string> groups() const override;
  void splitEscaped(const LightPoint& point, const vec3& wi,
                    std::span<Rgb> radiances) const override {
    split(escaped(point, wi).radiance, wi, radiances);
  }
  void splitBackground(const vec3& origin, const vec3& wi,
                       std::span<Rgb> radiances) const override {
    split(background(origin, wi), wi, radiances);
  }

 private:
  SplitProbe(std::unique_ptr<LightSource> strategy, const SunExtraction& extraction,
             const Rotation& rotation);
  void split(const Rgb& whole, const vec3& wi, std::span<Rgb> radiances) const;

  std::unique_ptr<LightSource> strategy_;
  bool hasSuns_;
  Probe rest_;  // without the suns
};

}  // namespace chromeball
