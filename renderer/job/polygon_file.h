// SPDX-License-Identifier: Apache-2.0
// Polygons of a probe's image as files (.json), as `chromeball lights --suggest` writes them.
#pragma once

#include <filesystem>

#include "probe/load.h"
#include "probe/polygon_source.h"

namespace chromeball {

using PolygonCorners = std::vector<glm::dvec2>;  // pixels of the probe's image, from its top left

// {"probe", "polygons": [{"probe_polygon": [[u, v], ...], ...}, ...]}; other members are ignored.
// Throws InputError for a file that is no such list.
std::vector<PolygonCorners> readPolygons(const std::filesystem::path& path);

// Also writes each source's solid angle, radiance and irradiance. Throws RunError.
void writePolygons(const std::filesystem::path& path, const std::string& probe,
                   const std::vector<PolygonCorners>& polygons,
                   const std::vector<PolygonSource>& sources);

// The polygon with these corners in the image of a probe's file, with great circles as edges.
// Throws InputError, which starts with `location`.
SphericalPolygon polygonOf(const PolygonCorners& corners, const LoadedProbe& probe,
                           const std::string& location);
// The corners in that image.
PolygonCorners cornersOf(const SphericalPolygon& polygon, const LoadedProbe& probe);

}  // namespace chromeball
