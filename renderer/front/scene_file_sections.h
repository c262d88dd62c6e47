// SPDX-License-Identifier: Apache-2.0
// The tables [[light]] of a scene file.
#pragma once

#include "front/scene_file.h"
#include "front/toml_section.h"
#include "scene/light.h"

namespace chromeball {

// Reads one table: a lamp, or the lamps of a list (lighting/export/light_list.h), whose path is
// added to `files`. Throws InputError.
std::vector<Lamp> readLamps(const Entry& entry, std::vector<std::string>& files);

// The tables [[source]] of a scene file: polygons of the probe that become sources of their own.

// Reads one table: adds a polygon, or the polygons of a file (polygon_file.h). Throws InputError.
void readSources(const Entry& entry, SceneFile& scene);

// The sections [composite] and [surroundings] of a scene file.

// Both throw InputError.
void readComposite(const Section& section, SceneFile& scene);
SurroundingsEntry readSurroundings(const Section& section);

}  // namespace chromeball
