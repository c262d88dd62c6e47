// SPDX-License-Identifier: Apache-2.0
// Lamps that a scene file adds to its models.
#pragma once

#include "scene/scene.h"

namespace chromeball {

// One of the two, with the name of its node.
struct Lamp {
  std::string name;
  std::optional<PunctualLight> punctual;
  std::optional<DiscLamp> disc;
};

// Adds the lamp, in the world whose point `origin` is the scene's origin. A disc becomes a
// single-sided emitting polygon of kDiscSides sides that has exactly its area.
inline constexpr int kDiscSides = 128;
void addLamp(Scene& scene, const Lamp& lamp, const glm::dvec3& origin);

}  // namespace chromeball
