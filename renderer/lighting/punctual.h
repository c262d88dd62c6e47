// SPDX-License-Identifier: Apache-2.0
// The lights without extent of a scene: delta lights beside the probe.
#pragma once

#include <memory>
#include <vector>

#include "lighting/strategy.h"
#include "scene/scene.h"

namespace chromeball {

// Light of one lamp at a point. No BSDF sample finds it, so MIS leaves it whole.
struct PunctualSample {
  vec3 wi;         // unit, from the point to the light
  float distance;  // metres; infinite for a directional light
  Rgb irradiance;  // on a surface that faces it
};

// What the light sends to a point (KHR_lights_punctual): intensity / distance^2, faded out towards
// the range by max(min(1 - (distance / range)^4, 1), 0), and for a spot towards the edge of its
// cone by ((cos - cosOuter) / (cosInner - cosOuter))^2.
PunctualSample shine(const PunctualLight& light, const vec3& position);

class PunctualLights {
 public:
  // Null where the scene has none: such a scene has no branch for them.
  static std::unique_ptr<PunctualLights> make(const Scene& scene);

  // Where there are more than this many, so many are chosen in proportion to the luminance of the
  // irradiance they send, and raised by as much.
  static constexpr int kFirst = 16, kLater = 2;  // at the first hit, and at later ones

  // Calls use(PunctualSample) for each sample of the point.
  template <class Use>
  void sample(const LightPoint& point, const PixelSampler& sampler, const Use& use) const {
    const size_t wanted = point.depth == 0 ? kFirst : kLater;
    if (lights_.size() > wanted) return choose(point, sampler, int(wanted), use);
    for (const PunctualLight& light : lights_)
      if (const PunctualSample s = shine(light, point.position); !isBlack(s.irradiance)) use(s);
  }

 private:
  explicit PunctualLights(const Scene& scene) : lights_(scene.lights) {}

  template <class Use>
  void choose(const LightPoint& point, const PixelSampler& sampler, int count,
              const Use& use) const {
    float total = 0;
    for (const PunctualLight& light : lights_)
      total += luminance(shine(light, point.position).irradiance);
    const float step = total / float(count);
    constexpr uint64_t kPurpose = 0x6c616d70;  // apart from other uses of the key
    float target = step * toUnit(uint32_t(hash(sampler.sampleKey(), kPurpose))), sum = 0;
    for (const PunctualLight& light : lights_) {
      PunctualSample s = shine(light, point.position);
      const float fraction = luminance(s.irradiance);
      sum += fraction;
      s.irradiance *= step / fraction;
      for (; fraction > 0 && sum > target; target += step) use(s);
    }
  }

  const std::vector<PunctualLight>& lights_;
};

}  // namespace chromeball
