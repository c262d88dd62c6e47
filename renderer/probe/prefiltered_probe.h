// SPDX-License-Identifier: Apache-2.0
// A probe as reflected by surfaces that see all of it (HDRI book, section 9.8.1).
#pragma once

#include <string_view>
#include <vector>

#include "image/image.h"
#include "probe/probe.h"

namespace chromeball {

// Tables of irradiance by normal, and of radiance by mirror direction and roughness: the probe
// under the GGX distribution seen along the normal (ZonalKernel::ggx). Interpolation errors are
// about 1e-3 of the irradiance and 1e-2 of the radiance (tests/prefiltered_probe_test.cpp).
class PrefilteredProbe {
 public:
  // A table for a narrower lobe would need many texels, each slow to compute; a sample of the lobe
  // has little noise.
  static constexpr float kLeastRoughness = 0.2f;

  // `roughnesses`: from kLeastRoughness to 1, of the tables to make; others are interpolated. A
  // table takes about three seconds of a core at most. The probe must outlive this.
  PrefilteredProbe(const Probe& probe, std::vector<float> roughnesses);

  // W/m^2 on a surface with this unit normal.
  Rgb irradiance(const vec3& normal) const { return kPi * diffuse_.radiance(normal); }

  // The radiance in a mirror of this perceptual roughness (alpha = roughness^2); 0 shows the probe
  // itself.
  Rgb radiance(const vec3& direction, float roughness) const;

 private:
  struct Level {
    float roughness;
    Probe map;
  };

  const Probe& probe_;
  Probe diffuse_;              // irradiance / pi, also the table for roughness 1
  std::vector<Level> levels_;  // by increasing roughness
};

// A probe as the chain of prefiltered cube maps that real-time renderers look up by roughness.

// The roughness of level k of n: in Khronos' glTF sample viewer, k / (n - 1); in Filament 1 -
// sqrt(1 - k / (n - 1)), the inverse of its roughness (2 - roughness).
enum class MipRoughness { Khronos, Filament };

// "khronos" or "filament". Throws InputError, begun by `location`.
MipRoughness parseMipRoughness(std::string_view text, std::string_view location);

struct CubeLevel {
  double roughness;  // GGX, alpha = roughness^2
  Image faces;       // six faces, one below another: +X -X +Y -Y +Z -Z
};

// Level 0 is the map itself, each texel a mean over its solid angle; the others are convolved by
// ZonalKernel::ggx, at the texels' centres. Faces halve from `size` to 16 (to `size` if that is
// less). The order of texels is such that OpenGL and Vulkan look them up by directions in this
// program's axes; seen from inside of the cube, faces are mirrored. Throws InputError unless `size`
// is a power of two from 1 to 4096.
std::vector<CubeLevel> cubeMips(const Image& latLong, int size, MipRoughness roughness);

}  // namespace chromeball
