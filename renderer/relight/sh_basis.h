// SPDX-License-Identifier: Apache-2.0
// Real spherical harmonics of any order.
#pragma once

#include <span>

#include "probe/mapping.h"

namespace chromeball {

constexpr int shCount(int order) { return (order + 1) * (order + 1); }

// Y_lm of a unit direction at l (l + 1) + m, for l up to `order`: orthonormal over the sphere, with
// the signs of shBasis() (probe/spherical_harmonics.h), whose nine functions are the first. By the
// recurrence of the normalised Legendre functions (Sloan 2013, "Efficient Spherical Harmonic
// Evaluation", section 2). `out` has shCount(order) elements.
void shBasis(const dvec3& direction, int order, std::span<double> out);

}  // namespace chromeball
