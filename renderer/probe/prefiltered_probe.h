// SPDX-License-Identifier: Apache-2.0
// A probe as surfaces reflect it that see all of it (HDRI book, section 9.8.1).
#pragma once

#include <vector>

#include "probe/probe.h"

namespace chromeball {

// Tables of irradiance by normal, and of radiance by mirror direction and roughness: the probe
// under the GGX distribution seen along the normal (ZonalKernel::ggx). Interpolation errors are
// about 1e-3 of the irradiance and 1e-2 of the radiance (tests/prefiltered_probe_test.cpp).
class PrefilteredProbe {
 public:
  // A table for a narrower lobe would need many texels, each of which takes long; a sample of the
  // lobe has little noise.
  static constexpr float kLeastRoughness = 0.2f;

  // `roughnesses`: from kLeastRoughness to 1, of the tables to make; others are interpolated. A
  // table takes about two seconds of a core at most. The probe must outlive this.
  PrefilteredProbe(const Probe& probe, std::vector<float> roughnesses);

  // W/m^2 on a surface with this unit normal.
  Rgb irradiance(const vec3& normal) const { return kPi * diffuse_.radiance(normal); }

  // In a mirror of this perceptual roughness (alpha = roughness^2); 0 is the probe itself.
  Rgb radiance(const vec3& direction, float roughness) const;

 private:
  struct Level {
    float roughness;
    Probe map;
  };

  const Probe& probe_;
  Probe diffuse_;              // irradiance / pi, which is also that of roughness 1
  std::vector<Level> levels_;  // by increasing roughness
};

}  // namespace chromeball
