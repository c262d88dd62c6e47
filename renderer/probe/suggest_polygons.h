// SPDX-License-Identifier: Apache-2.0
// Proposes the polygons of windows and lamps in a probe, for [[source]].
#pragma once

#include <vector>

#include "image/image.h"
#include "math/polygon.h"

namespace chromeball {

// Proposals: convex polygons around the connected regions whose luminance is above 4 times the mean
// of the sphere, at most `count`, in order of decreasing flux; without regions that reach more than
// 60 degrees from their middle. Where the uneven part of a region's flux is more than the flux of
// the next region, the former is cut in two instead, through the middle of its flux and across the
// direction in which that is spread most.
std::vector<SphericalPolygon> suggestPolygons(const Image& latLong, int count);

}  // namespace chromeball
