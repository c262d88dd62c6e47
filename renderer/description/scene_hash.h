// SPDX-License-Identifier: Apache-2.0
// Tells a scene in memory from others.
#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace chromeball {

// Of everything that rays and cameras see: geometry, materials, texels, lights, cameras. In one
// pass over the arrays.
uint64_t hashOf(const Scene& scene);

}  // namespace chromeball
