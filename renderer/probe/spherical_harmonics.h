// SPDX-License-Identifier: Apache-2.0
// Spherical harmonics to order 2: nine coefficients per channel.
#pragma once

#include <array>

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

// L00, L1-1, L10, L11, L2-2, L2-1, L20, L21, L22.
inline constexpr int kShCount = 9;
using ShCoefficients = std::array<dvec3, kShCount>;

// The real basis Y_lm at a unit direction. Y10 is proportional to z, which points towards the
// viewer here. (In Ramamoorthi and Hanrahan 2001 z points into the image, so their L10, L2-1 and
// L21 have the opposite sign.)
std::array<double, kShCount> shBasis(const dvec3& direction);

// L_lm = integral of radiance x Y_lm over the sphere, for a lat-long map that is constant over each
// texel: Y_lm at the texel's centre times its exact solid angle.
ShCoefficients projectSh(const Image& latLong);

// The convolution with a function of the angle to `direction` (unit) that has these Legendre
// moments, 2 pi times its integrals over the cosine times P0, P1 and P2 (Ramamoorthi and Hanrahan
// 2001, eq. 7).
dvec3 shConvolution(const ShCoefficients& radiance, const std::array<double, 3>& moments,
                    const dvec3& direction);

// Irradiance on a surface with unit `normal`: sum of A_l L_lm Y_lm(normal), with A_0 = pi,
// A_1 = 2 pi / 3, A_2 = pi / 4 (Ramamoorthi and Hanrahan 2001, eq. 8). Bands above 2 hold less than
// 1% of the squared irradiance over all normals, but the error is larger: over 21 captured probes
// the mean absolute error is 1 to 10% of the mean irradiance and the maximum 4 to 30%; next to suns
// and lamps the sum can be negative.
dvec3 shIrradiance(const ShCoefficients& radiance, const dvec3& normal);

}  // namespace chromeball
