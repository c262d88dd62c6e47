// SPDX-License-Identifier: Apache-2.0
// Strategies that sample a probe, and the two simplest of them.
#pragma once

#include "lighting/light_source.h"
#include "math/vec.h"
#include "math/warp.h"
#include "probe/probe.h"

namespace chromeball {

// The camera and mirrors see the probe.
class ProbeLight : public LightSource {
 public:
  explicit ProbeLight(const Probe& probe) : probe_(probe) {}

  Rgb background(const vec3&, const vec3& wi) const override { return probe_.radiance(wi); }

 protected:
  const Probe& probe_;
};

// `uniform`: directions uniform over the hemisphere of the normal, pdf 1 / 2 pi.
class Uniform : public ProbeLight {
 public:
  using ProbeLight::ProbeLight;

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override {
    const vec3 local = squareToUniformHemisphere(sampler.get2(dimension::kLight));
    const vec3 wi = Frame(point.normal).toWorld(local);
    out.push_back({wi, probe_.radiance(wi) * (2 * kPi), 0.5f * kInvPi});
  }
  Escaped escaped(const LightPoint& point, const vec3& wi) const override {
    return {probe_.radiance(wi), glm::dot(point.normal, wi) > 0 ? 0.5f * kInvPi : 0};
  }
  bool takesOneSample() const override { return true; }
};

// `bsdf`: no light samples; BSDF samples find the probe (HDRI book, section 9.5).
class BsdfOnly : public ProbeLight {
 public:
  using ProbeLight::ProbeLight;

  void sample(const LightPoint&, const PixelSampler&,
              std::vector<DirectionSample>&) const override {}
  Escaped escaped(const LightPoint&, const vec3& wi) const override {
    return {probe_.radiance(wi), 0};
  }
};

}  // namespace chromeball
