// SPDX-License-Identifier: Apache-2.0
// `bsdf`: no light samples; BSDF samples find the probe (HDRI book, section 9.5).
#pragma once

#include "lighting/light_source.h"
#include "probe/probe.h"

namespace chromeball {

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
