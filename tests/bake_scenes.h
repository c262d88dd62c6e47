// SPDX-License-Identifier: Apache-2.0
// Scenes and charts for the tests of baking.
#pragma once

#include "bake/atlas.h"
#include "small_scenes.h"

namespace chromeball {

std::vector<Chart> chartsOf(const std::vector<PlacedMesh>& meshes);

// A closed box, whose faces look outwards.
void addBox(Scene& scene, int material, vec3 low, vec3 high);

// A ramp that winds twice around an axis: above itself, and nearly flat.
Mesh spiral();

Scene varied();

}  // namespace chromeball
