// SPDX-License-Identifier: Apache-2.0
// Rotations: spread evenly, and by a vector.
#pragma once

#include <vector>

#include "math/vec.h"

namespace chromeball {

// So many rotations with no large gap between them: a super-Fibonacci spiral of unit quaternions
// (Alexa 2022).
std::vector<glm::dmat3> spreadRotations(int count);

// The rotation about `axis` by its length in radians.
glm::dmat3 rotationBy(const glm::dvec3& axis);

// The angle between two rotations, in radians.
double angleBetween(const glm::dmat3& a, const glm::dmat3& b);

}  // namespace chromeball
