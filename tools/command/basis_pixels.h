// SPDX-License-Identifier: Apache-2.0
// chromeball basis SCENE --directions lat-long:32x16 -o STAGE.exr: a light stage of a scene.
#pragma once

#include <string>

#include "scene_options.h"

namespace chromeball {

struct PixelBasis {
  std::string directions, out;
  bool halves = false;
};

// Renders and writes bands of rows, as few as the memory allows.
void runBasisPixels(const SceneOptions& options, const PixelBasis& own);

}  // namespace chromeball
