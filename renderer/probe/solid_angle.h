// SPDX-License-Identifier: Apache-2.0
// Solid angles of texels, in steradians.
#pragma once

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

// Exact, for every texel of `row` in a lat-long map: (2 pi / W)(cos(top) - cos(bottom)). The
// texels of a map sum to 4 pi.
double texelSolidAngle(int row, int width, int height);

// d(solid angle) / d(u v) at a valid point of a mapping.
double solidAnglePdf(Mapping mapping, const dvec2& uv);

// Mean over the sphere of a lat-long map whose texels are constant: sum of radiance times solid
// angle, over 4 pi.
dvec3 meanRadiance(const Image& latLong);

}  // namespace chromeball
