// SPDX-License-Identifier: Apache-2.0
// Test helpers: a floor in surroundings at a finite distance.
#pragma once

#include "lighting/finite_surroundings.h"
#include "measure/statistics.h"
#include "test_scene.h"

namespace chromeball {

// A box around the floor, with the probe's capture point inside.
Surroundings box();

Image spotted();

vec3 sphereDirection(uint64_t i);

// Exitant radiance of a small area of the floor around (x, z), seen from above. The moments are
// over `repeats` renders with different seeds.
Moments floorRadiance(const LightSource& lighting, float x, float z, int repeats);

}  // namespace chromeball
