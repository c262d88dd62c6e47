// SPDX-License-Identifier: Apache-2.0
// Suns that a scene has besides its probe (HDRI book, sections 9.3.5 and 9.6.1).
#pragma once

#include "lighting/light_source.h"
#include "lighting/sky_discs.h"
#include "scene/light.h"

namespace chromeball {

// The camera and mirrors see the visible discs; all other rays find all discs.
class SceneSuns : public LightSource {
 public:
  explicit SceneSuns(const std::vector<SunLamp>& suns);

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint&, const vec3& wi) const override {
    const SkyDiscs::Light light = all_.at(wi);
    return {light.radiance, light.pdf};
  }
  Rgb background(const vec3&, const vec3& wi) const override { return visible_.at(wi).radiance; }
  std::vector<std::string> groups() const override { return names_; }
  void splitEscaped(const LightPoint& point, const vec3& wi,
                    std::span<Rgb> radiances) const override;
  void splitBackground(const vec3& origin, const vec3& wi, std::span<Rgb> radiances) const override;

 private:
  SkyDiscs all_, visible_;
  std::vector<std::string> names_;  // of all
  std::vector<size_t> seen_;        // indices of the visible ones
};

}  // namespace chromeball
