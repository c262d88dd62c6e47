// SPDX-License-Identifier: Apache-2.0
#include "integrate/world.h"

namespace chromeball {

World::World(const Scene& described, const std::vector<RayMask>& masks)
    : scene(described),
      accel(described, masks),
      emitters(Emitters::make(described)),
      punctual(PunctualLights::make(described)),
      bsdfTables(described.materials) {}

}  // namespace chromeball
