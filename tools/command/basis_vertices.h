// SPDX-License-Identifier: Apache-2.0
// chromeball basis MODEL --at vertices -o MODEL_PRT.glb: precomputed radiance transfer.
#pragma once

#include "scene_options.h"

namespace chromeball {

// `basis`: its name, from --basis. Throws InputError and RunError.
void runBasisVertices(const SceneOptions& options, const std::string& basis,
                      const std::string& output);

}  // namespace chromeball
