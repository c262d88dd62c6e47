// SPDX-License-Identifier: Apache-2.0
// Solid angles of texels, in steradians.
#pragma once

#include <cstddef>

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

// The exact solid angle of a texel in `row` of a lat-long map: (2 pi / W)(cos(top) - cos(bottom)).
// All texels sum to 4 pi.
double texelSolidAngle(int row, int width, int height);

// Calls visit(x, y, radiance, solid angle) for each texel of a lat-long map, row by row.
template <class Visit>
void forTexels(const Image& latLong, const Visit& visit) {
  for (int y = 0; y < latLong.height; ++y) {
    const double solidAngle = texelSolidAngle(y, latLong.width, latLong.height);
    for (int x = 0; x < latLong.width; ++x) visit(x, y, latLong.rgb(x, y), solidAngle);
  }
}

// d(solid angle) / d(u v) at a valid position of a mapping.
double solidAngleJacobian(Mapping mapping, const dvec2& uv);

// The solid angles of the texels of an image whose centres show a direction.
struct TexelSolidAngles {
  double min, max;
  size_t texels;
};

// Exact but for discs other than of equal area (the mirror ball), where the texel's centre stands
// for all of it; texels on the rim of a disc count as if they were inside.
TexelSolidAngles texelSolidAngles(Mapping mapping, const ImageSize& image);

// The mean over the sphere of a lat-long map, constant over each texel: sum of radiance x solid
// angle / (4 pi).
dvec3 meanRadiance(const Image& latLong);

}  // namespace chromeball
