// SPDX-License-Identifier: Apache-2.0
// Affine transforms.
#pragma once

#include "math/vec.h"

namespace chromeball {

// Row r of the matrix is (linear[0][r], linear[1][r], linear[2][r], translation[r]).
struct Transform {
  glm::mat3 linear{1};
  vec3 translation{0};

  vec3 point(const vec3& p) const { return linear * p + translation; }
  bool operator==(const Transform&) const = default;
};

}  // namespace chromeball
