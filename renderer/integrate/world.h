// SPDX-License-Identifier: Apache-2.0
// A scene made ready for light transport.
#pragma once

#include <memory>
#include <vector>

#include "lighting/emitters.h"
#include "lighting/punctual.h"
#include "scene/scene.h"
#include "shading/bsdf_tables.h"
#include "trace/accel.h"

namespace chromeball {

// What all renders of a scene share, whatever lights it: the acceleration structure, and a table of
// each kind of light and of material that the scene has.
struct World {
  // `masks`: of the instances, for rays that see a part of the scene (trace/ray.h); empty: every
  // ray sees all. `described` must outlive this. Throws RunError.
  explicit World(const Scene& described, const std::vector<RayMask>& masks = {});

  const Scene& scene;
  const Accel accel;
  const std::unique_ptr<const Emitters> emitters;        // null where nothing emits
  const std::unique_ptr<const PunctualLights> punctual;  // null where there are none
  const BsdfTables bsdfTables;                           // those that its materials need
};

}  // namespace chromeball
