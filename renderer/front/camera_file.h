// SPDX-License-Identifier: Apache-2.0
// Writes cameras to files with a section [camera], which scene files name.
#pragma once

#include <string>
#include <vector>

#include "scene/solve/solved_camera.h"

namespace chromeball {

// Atomically, with a comment line for each of `comments`. Throws RunError.
void writeCameraFile(const std::string& path, const SolvedCamera& camera,
                     const std::vector<std::string>& comments);

// A point on the camera's axis, so far away that rounding to floats does not turn the camera.
glm::dvec3 lookAt(const SolvedCamera& camera);

}  // namespace chromeball
