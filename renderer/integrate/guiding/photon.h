// SPDX-License-Identifier: Apache-2.0
// Light of the probe that mirrors, metals and glass throw onto rough surfaces: paths from the probe
// (Jensen 1996, "Global Illumination using Photon Maps").
#pragma once

#include <cstdint>
#include <vector>

#include "integrate/world.h"
#include "lighting/strategy.h"

namespace chromeball {

// A bounce with a larger pdf, over solid angle, belongs to a narrow lobe. (A diffuse bounce has
// 1 / pi at most, a GGX lobe of roughness 0.45 has 2.)
inline constexpr float kConcentratedPdf = 2;

// Where such a path arrives at a rough surface.
struct Photon {
  vec3 position, normal;
  vec3 direction;  // unit, towards the last surface that reflected or refracted the light
  vec3 emission;   // unit, towards the light on the probe
  uint32_t chain;  // a hash of the instances that reflected or refracted the light, in order
  float flux;      // luminance
};

// Traces `count` paths from light samples of the strategy towards instances with narrow lobes; none
// if there are no such instances, or if light samples depend on the point
// (LightingStrategy::sampleMany()). Does not depend on the number of threads.
std::vector<Photon> tracePhotons(const World& world, const LightingStrategy& lighting, size_t count,
                                 uint64_t seed);

}  // namespace chromeball
