// SPDX-License-Identifier: Apache-2.0
// Reads a cube map in six files of a folder, one for each face.
#pragma once

#include <filesystem>

#include "image/io/cube_files.h"
#include "image/io/read_image.h"

namespace chromeball {

// The faces side by side, as a Mapping::HorizontalStrip whose metadata name it. Each shows its
// square as seen from inside. The front is at -Z and the right at +X. Names of axes are read as
// OpenEXR's, or as those of OpenGL and Direct3D, where pz is the front: the two differ in what is
// to the right of px, and the edges decide, if they do so beyond chance, else they are OpenGL's (a
// note says so). Throws InputError for a face that is not square or of another size than the first.
ImageFile readCubeFaces(const std::filesystem::path& folder, const CubeFaces& faces);

}  // namespace chromeball
