// SPDX-License-Identifier: Apache-2.0
// chromeball basis MODEL --at vertices -o MODEL_PRT.glb: precomputed radiance transfer.
#pragma once

#include "scene_options.h"

namespace chromeball {

struct BasisVerticesOptions : SceneOptions {
  std::string basis = "sh:4", output;
};

// Throws InputError and RunError.
void runBasisVertices(const BasisVerticesOptions& options);

}  // namespace chromeball
