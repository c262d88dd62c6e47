// SPDX-License-Identifier: Apache-2.0
// A cube map in six files of a folder, one for each face.
#pragma once

#include <array>
#include <filesystem>

#include "image/io/read_image.h"

namespace chromeball {

// The names of the files, without extension, end with px nx py ny pz nz, or posx negx ..., or right
// left top bottom front back; what is before that is the same in all six and ends with one of `_-.`
// or a space.
struct CubeFaces {
  std::array<std::filesystem::path, 6> files;  // in the order of Mapping::HorizontalStrip
  bool namesAxes = false;                      // and not sides
};

// The one complete cube map in the folder. Throws InputError if there is none, or several.
CubeFaces findCubeFaces(const std::filesystem::path& folder);

// The faces side by side, as a Mapping::HorizontalStrip whose metadata name it. Each shows its
// square as seen from inside. The front is at -Z and the right at +X. Names of axes are read as
// OpenEXR's, or as those of OpenGL and Direct3D, where pz is the front: the two differ in what is
// to the right of px, and the edges decide (a note says so). Throws InputError for a face that is
// not square or of another size than the first.
ImageFile readCubeFaces(const std::filesystem::path& folder, const CubeFaces& faces);

// Whether the file is one of at least five faces of a cube map in its folder.
bool isCubeFace(const std::filesystem::path& file);

}  // namespace chromeball
