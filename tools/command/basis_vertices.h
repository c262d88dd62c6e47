// SPDX-License-Identifier: Apache-2.0
// chromeball basis MODEL --at vertices [--glossy] -o MODEL_PRT.glb: precomputed radiance transfer.
#pragma once

#include "scene_options.h"

namespace chromeball {

struct BasisVerticesOptions {
  std::string basis, output;
  bool isGlossy = false;
  uint64_t clusters = 16, vectors = 8;  // of glossy transfer
};

// Throws InputError and RunError.
void runBasisVertices(const SceneOptions& options, const BasisVerticesOptions& own);

}  // namespace chromeball
