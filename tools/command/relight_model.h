// SPDX-License-Identifier: Apache-2.0
// chromeball relight MODEL_PRT.glb --probe PROBE -o MODEL_LIT.glb: vertex colours by transfer.
#pragma once

#include <optional>
#include <string>

#include "math/rotation.h"

namespace chromeball {

struct RelightModelOptions {
  std::string model, output, probe, mapping, scale;
  std::string keep;  // "25" coefficients, or "10%"
  Rotation rotation;
  std::string view;             // "X,Y,Z", metres: the eye, of glossy transfer; else empty
  std::optional<double> white;  // the light that the file's white stands for
  bool allowsExternal = false, quiet = false;
};

// Throws InputError and RunError.
void runRelightModel(const RelightModelOptions& options);

}  // namespace chromeball
