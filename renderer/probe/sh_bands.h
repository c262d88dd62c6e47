// SPDX-License-Identifier: Apache-2.0
// Spherical harmonics to any order. Order 2, with the sum for irradiance, is in
// spherical_harmonics.h.
#pragma once

#include <span>
#include <vector>

#include "image/image.h"
#include "math/rotation.h"
#include "probe/mapping.h"

namespace chromeball {

inline constexpr int kMaxShOrder = 12;

// Of bands 0 to `order`.
constexpr int shCountOf(int order) { return (order + 1) * (order + 1); }

// The real basis at a unit direction, as shBasis(): Y_lm is out[l (l + 1) + m], with the z axis as
// its pole and without the phase (-1)^m (Green 2003: "Spherical Harmonic Lighting: The Gritty
// Details"). `out` has shCountOf(order) elements.
void shBasis(const dvec3& direction, int order, std::span<double> out);

// As the projection to order 2: radiance x Y_lm, integrated over the sphere, of a map that is
// constant over each texel and turned by `rotation`.
std::vector<dvec3> projectSh(const Image& latLong, int order, const Rotation& rotation);

// A_l: what a band of radiance times this is the same band of irradiance (Ramamoorthi and Hanrahan
// 2001, eq. 8): pi, 2 pi / 3, pi / 4, 0, -pi / 24, 0, ...
double shCosineFactor(int band);

}  // namespace chromeball
