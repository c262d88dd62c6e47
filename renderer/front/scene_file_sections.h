// SPDX-License-Identifier: Apache-2.0
// Readers of the sections and tables of a scene file.
#pragma once

#include "front/scene_file.h"
#include "front/toml_section.h"
#include "scene/light.h"
#include "scene/solve/solve_camera.h"

#include <string>
#include <vector>

namespace chromeball {

// [[light]]: reads one table, a lamp, or the lamps of a list (lighting/export/light_file.h), whose
// path is added to `files`. Throws InputError.
std::vector<Lamp> readLamps(const Entry& entry, std::vector<std::string>& files);

// The tables [[source]] of a scene file: polygons of the probe that become sources of their own.

// Reads one table: adds a polygon, or the polygons of a file (polygon_file.h). Throws InputError.
void readSources(const Entry& entry, SceneFile& scene);

// The sections [composite] and [surroundings] of a scene file.

// Both throw InputError.
void readComposite(const Section& section, SceneFile& scene);
SurroundingsEntry readSurroundings(const Section& section);

// The section [camera] of a scene file, also in a file of its own.

// Throws InputError.
void readCamera(const Section& section, SceneFile& scene);

// Replaces the camera of `scene` by the camera of a file with nothing but [camera] with `position`
// and `look_at`, as `chromeball camera solve` writes it. Throws InputError.
void readCameraFile(const std::string& path, SceneFile& scene);

// Writes cameras to files with a section [camera], which scene files name.

// Writes atomically, with a comment line for each of `comments`. Throws RunError.
void writeCameraFile(const std::string& path, const SolvedCamera& camera,
                     const std::vector<std::string>& comments);

// A point on the camera's axis, so far away that rounding to floats does not turn the camera.
glm::dvec3 lookAt(const SolvedCamera& camera);

}  // namespace chromeball
