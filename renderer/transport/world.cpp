// SPDX-License-Identifier: Apache-2.0
#include "transport/world.h"

namespace chromeball {

World::World(const Scene& described, const std::vector<RayMask>& masks)
    : World(described, masks, BsdfTables(described.materials)) {}

World::World(const Scene& described, const std::vector<RayMask>& masks, const BsdfTables& tables,
             std::shared_ptr<BuiltGeometry> earlier)
    : scene(described),
      accel(described, masks, std::move(earlier)),
      sources(described),
      sharedPlaces(accel),
      bsdfTables(tables) {}

}  // namespace chromeball
