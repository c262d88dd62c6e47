// SPDX-License-Identifier: Apache-2.0
// The tables [[source]] of a scene file: polygons of the probe that become sources of their own.
#pragma once

#include "job/toml_section.h"

namespace chromeball {

struct SourceEntry {
  std::string name, location;       // location: FILE:LINE, begins an error
  std::vector<glm::dvec2> corners;  // positions in the probe's image, in pixels from its top left
  bool isIllum = true;
};

// Reads one table: a polygon, or the polygons of a file (polygon_file.h), whose path is added to
// `files`. Throws InputError.
std::vector<SourceEntry> readSources(const Entry& entry, std::vector<std::string>& files);

}  // namespace chromeball
