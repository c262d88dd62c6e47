// SPDX-License-Identifier: Apache-2.0
// Paths from the light, for guided bounces.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "guiding/caustic_guide.h"
#include "lighting/strategy.h"
#include "transport/world.h"

namespace chromeball {

struct PhotonBudget {
  size_t paths;
  double rays = INFINITY;  // the first 4,096 paths are always traced
};

// Traces paths from light samples of the strategy towards instances with narrow lobes, and as many
// from emissive triangles, up to the budget; none if there are no such instances, or if the first
// leave no photons. Where the light's directions depend on the point
// (LightSource::sampleDistant()), only lamps have photons. The result does not depend on the number
// of threads.
std::vector<Photon> tracePhotons(const World& world, const LightSource& lighting,
                                 const PhotonBudget& budget, uint64_t seed);

}  // namespace chromeball
