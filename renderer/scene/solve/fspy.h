// SPDX-License-Identifier: Apache-2.0
// The camera of a file of fSpy (fspy.io): its menu Export, Camera parameters as JSON.
#pragma once

#include <filesystem>

#include "scene/solve/solved_camera.h"

namespace chromeball {

// The file has, among others, cameraTransform (from the camera, which looks along -Z with +Y up, to
// the scene; rows), verticalFieldOfView (radians), principalPoint (from the middle of the image, in
// units of half its longer side, y up), imageWidth and imageHeight. `zUp`: the scene's z axis is
// up, as in Blender, and becomes Y: (x, y, z) is (x, z, -y) here. Throws InputError.
SolvedCamera readFspy(const std::filesystem::path& path, bool zUp);

}  // namespace chromeball
