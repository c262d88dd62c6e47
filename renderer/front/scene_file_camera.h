// SPDX-License-Identifier: Apache-2.0
// The section [camera] of a scene file, also in a file of its own.
#pragma once

#include <string>
#include <vector>

#include "front/scene_file.h"
#include "front/toml_section.h"
#include "scene/solve/solved_camera.h"

namespace chromeball {

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
