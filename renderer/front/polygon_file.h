// SPDX-License-Identifier: Apache-2.0
// Polygons of a probe's image as files (.json), as `chromeball lights --suggest` writes them.
#pragma once

#include <filesystem>

#include "probe/polygon_source.h"

namespace chromeball {

// Reads {"probe", "polygons": [{"probe_polygon": [[u, v], ...], ...}, ...]}; other members are
// ignored. Throws InputError for a file that is no such list.
std::vector<PolygonCorners> readPolygons(const std::filesystem::path& path);

// Also writes each source's solid angle, radiance and irradiance. Throws RunError.
void writePolygons(const std::filesystem::path& path, const std::string& probe,
                   const std::vector<PolygonCorners>& polygons,
                   const std::vector<PolygonSource>& sources);

}  // namespace chromeball
