// SPDX-License-Identifier: Apache-2.0
// A scene's point, spot and directional lights (KHR_lights_punctual).
#pragma once

#include <memory>
#include <vector>

#include "lighting/strategy.h"
#include "scene/scene.h"

namespace chromeball {

// The light of one lamp at a point. No BSDF sample can find a delta light, so its MIS weight is 1.
struct PunctualSample {
  vec3 wi;          // unit, from the point to the light
  float distance;   // metres; infinite for a directional light
  Rgb irradiance;   // on a surface that faces it
  size_t lamp = 0;  // index into Scene::lights
};

// The light that arrives at `position` (KHR_lights_punctual): intensity / distance^2, times
// max(min(1 - (distance / range)^4, 1), 0) for the range, and for a spot times
// ((cos - cosOuter) / (cosInner - cosOuter))^2, clamped to [0, 1] before squaring.
PunctualSample incidentLight(const PunctualLight& light, const vec3& position);

class PunctualLights {
 public:
  // Null if the scene has none.
  static std::unique_ptr<PunctualLights> make(const Scene& scene);

  // The maximum number of samples at the first hit and at later hits. With more lights, this many
  // are chosen with probability proportional to the luminance of their irradiance, and divided by
  // the probability.
  static constexpr int kFirst = 16, kLater = 2;

  // Calls use(PunctualSample) for each sample.
  template <class Use>
  void sample(const LightPoint& point, const PixelSampler& sampler, const Use& use) const {
    const size_t wanted = point.depth == 0 ? kFirst : kLater;
    if (lights_.size() > wanted) return choose(point, sampler, int(wanted), use);
    for (size_t i = 0; i < lights_.size(); ++i)
      if (const PunctualSample s = sampleOf(i, point); !isBlack(s.irradiance)) use(s);
  }

 private:
  explicit PunctualLights(const Scene& scene) : lights_(scene.lights) {}

  PunctualSample sampleOf(size_t i, const LightPoint& point) const {
    PunctualSample s = incidentLight(lights_[i], point.position);
    s.lamp = i;
    return s;
  }

  template <class Use>
  void choose(const LightPoint& point, const PixelSampler& sampler, int count,
              const Use& use) const {
    float total = 0;
    for (const PunctualLight& light : lights_)
      total += luminance(incidentLight(light, point.position).irradiance);
    const float step = total / float(count);
    constexpr uint64_t kPurpose = 0x6c616d70;  // separate random stream
    float target = step * toUnit(uint32_t(hash(sampler.sampleKey(), kPurpose))), sum = 0;
    for (size_t i = 0; i < lights_.size(); ++i) {
      PunctualSample s = sampleOf(i, point);
      const float weight = luminance(s.irradiance);
      sum += weight;
      s.irradiance *= step / weight;
      for (; weight > 0 && sum > target; target += step) use(s);
    }
  }

  const std::vector<PunctualLight>& lights_;
};

}  // namespace chromeball
