// SPDX-License-Identifier: Apache-2.0
// `uniform`: directions uniform over the hemisphere of the normal, pdf 1 / 2 pi.
#pragma once

#include "lighting/light_source.h"
#include "math/vec.h"
#include "math/warp.h"
#include "probe/probe.h"

namespace chromeball {

class Uniform : public LightSource {
 public:
  explicit Uniform(const Probe& probe) : probe_(probe) {}

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override {
    const vec3 local = squareToUniformHemisphere(sampler.get2(dimension::kLight));
    const vec3 wi = Frame(point.normal).toWorld(local);
    out.push_back({wi, probe_.radiance(wi) * (2 * kPi), 0.5f * kInvPi});
  }
  Escaped escaped(const LightPoint& point, const vec3& wi) const override {
    return {probe_.radiance(wi), glm::dot(point.normal, wi) > 0 ? 0.5f * kInvPi : 0};
  }
  Rgb background(const vec3&, const vec3& wi) const override { return probe_.radiance(wi); }
  bool unbiased() const override { return true; }

 private:
  const Probe& probe_;
};

// `bsdf`: no light samples; BSDF samples find the probe (HDRI book, section 9.5).

class BsdfOnly : public LightSource {
 public:
  explicit BsdfOnly(const Probe& probe) : probe_(probe) {}

  void sample(const LightPoint&, const PixelSampler&,
              std::vector<DirectionSample>&) const override {}
  Escaped escaped(const LightPoint&, const vec3& wi) const override {
    return {probe_.radiance(wi), 0};
  }
  Rgb background(const vec3&, const vec3& wi) const override { return probe_.radiance(wi); }
  bool unbiased() const override { return true; }

 private:
  const Probe& probe_;
};

}  // namespace chromeball
