// SPDX-License-Identifier: Apache-2.0
// Lamps that a scene file adds to the models ([[light]]).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/light.h"

namespace chromeball {

// Exactly one of `punctual`, `disc`, `sun` and `ambient` is set.
struct Lamp {
  std::string name;  // of its node
  // In the world, metres; of a punctual light or disc, whose own is not used.
  glm::dvec3 position{0};
  std::optional<PunctualLight> punctual;
  std::optional<DiscLamp> disc;
  std::optional<SunLamp> sun;
  std::optional<AmbientLamp> ambient;
};

}  // namespace chromeball
