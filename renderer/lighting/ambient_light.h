// SPDX-License-Identifier: Apache-2.0
// Constant radiance from all directions, as light lists have it (lighting/light_file.h).
#pragma once

#include "lighting/strategy.h"

namespace chromeball {

// A part of a CombinedLight. Found by BSDF samples only, which for constant radiance are as good as
// light samples.
class AmbientLight : public LightingStrategy {
 public:
  AmbientLight(const Rgb& radiance, bool isVisible, std::string name)
      : radiance_(radiance), isVisible_(isVisible), name_(std::move(name)) {}

  void sample(const LightPoint&, const PixelSampler&,
              std::vector<DirectionSample>&) const override {}
  Escaped escaped(const LightPoint&, const vec3&) const override { return {radiance_, 0}; }
  Rgb background(const vec3&, const vec3&) const override {
    return isVisible_ ? radiance_ : Rgb(0);
  }
  bool unbiased() const override { return true; }
  std::vector<std::string> groups() const override { return {name_}; }

 private:
  Rgb radiance_;
  bool isVisible_;
  std::string name_;
};

}  // namespace chromeball
