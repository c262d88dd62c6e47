// SPDX-License-Identifier: Apache-2.0
// Three scenes with probes that together cover most kinds of materials and lights.
#pragma once

#include "test_scene.h"

namespace chromeball {

struct NamedScene {
  const char* name;
  Scene scene;
  Image probe;
};

std::vector<NamedScene> threeScenes();

}  // namespace chromeball
