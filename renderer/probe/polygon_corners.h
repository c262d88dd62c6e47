// SPDX-License-Identifier: Apache-2.0
// Polygons of a probe by their corners in its image.
#pragma once

#include <string>
#include <vector>

#include "probe/load.h"
#include "probe/polygon_source.h"

namespace chromeball {

using PolygonCorners = std::vector<glm::dvec2>;  // pixels of the probe's image, from its top left

// The polygon with these corners in the image of a probe's file, with great circles as edges.
// Throws InputError, which starts with `location`.
SphericalPolygon polygonOf(const PolygonCorners& corners, const LoadedProbe& probe,
                           const std::string& location);
// The corners in that image.
PolygonCorners cornersOf(const SphericalPolygon& polygon, const LoadedProbe& probe);

}  // namespace chromeball
