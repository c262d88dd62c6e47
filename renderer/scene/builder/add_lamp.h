// SPDX-License-Identifier: Apache-2.0
// Lamps of a scene file, added to a scene.
#pragma once

#include "scene/light.h"
#include "scene/scene.h"

namespace chromeball {

// Adds the lamp to the scene, whose origin is at `origin` in world space. A disc becomes a
// single-sided emitting polygon of kDiscSides sides with exactly the area of the disc.
inline constexpr int kDiscSides = 128;
void addLamp(Scene& scene, const Lamp& lamp, const glm::dvec3& origin);

}  // namespace chromeball
