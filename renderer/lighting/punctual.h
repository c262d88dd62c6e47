// SPDX-License-Identifier: Apache-2.0
// A scene's point, spot and directional lights (KHR_lights_punctual).
#pragma once

#include <memory>
#include <vector>

#include "lighting/light_source.h"
#include "scene/scene.h"

namespace chromeball {

// The light that arrives at `position` (KHR_lights_punctual): intensity / distance^2, times
// max(min(1 - (distance / range)^4, 1), 0) for the range, and for a spot times ((cos - cosOuter) /
// (cosInner - cosOuter))^2, clamped to [0, 1] before squaring. A delta light. `time`: within the
// shutter interval.
DirectionSample incidentLight(const PunctualLight& light, const vec3& position, float time = 0);

class PunctualLights : public LightSource {
 public:
  // Null if the scene has none. The scene must outlive this.
  static std::unique_ptr<PunctualLights> make(const Scene& scene);

  // The maximum number of samples at the first hit and at later hits. With more lights, this many
  // are chosen with probability proportional to the luminance of their irradiance, and divided by
  // the probability.
  static constexpr int kFirst = 16, kLater = 2;

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  std::vector<std::string> groups() const override;

 private:
  explicit PunctualLights(const Scene& scene) : lights_(scene.lights) {}

  DirectionSample sampleOf(size_t i, const LightPoint& point) const;
  void choose(const LightPoint& point, const PixelSampler& sampler, int count,
              std::vector<DirectionSample>& out) const;

  const std::vector<PunctualLight>& lights_;
};

}  // namespace chromeball
