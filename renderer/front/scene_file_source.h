// SPDX-License-Identifier: Apache-2.0
// The tables [[source]] of a scene file: polygons of the probe that become sources of their own.
#pragma once

#include "front/scene_file.h"
#include "front/toml_section.h"

namespace chromeball {

// Reads one table: adds a polygon, or the polygons of a file (polygon_file.h). Throws InputError.
void readSources(const Entry& entry, SceneFile& scene);

}  // namespace chromeball
