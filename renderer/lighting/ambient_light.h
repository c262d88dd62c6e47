// SPDX-License-Identifier: Apache-2.0
// Constant radiance from all directions, as light lists have it (lighting/light_file.h).
#pragma once

#include "lighting/light_source.h"
#include "scene/light.h"

namespace chromeball {

// Found by BSDF samples only, which for constant radiance are as good as light samples.
class AmbientLight : public LightSource {
 public:
  explicit AmbientLight(const AmbientLamp& lamp) : lamp_(lamp) {}

  void sample(const LightPoint&, const PixelSampler&,
              std::vector<DirectionSample>&) const override {}
  Escaped escaped(const LightPoint&, const vec3&) const override { return {lamp_.radiance, 0}; }
  Rgb background(const vec3&, const vec3&) const override {
    return lamp_.isVisible ? lamp_.radiance : Rgb(0);
  }
  std::vector<std::string> groups() const override { return {lamp_.name}; }

 private:
  AmbientLamp lamp_;
};

}  // namespace chromeball
