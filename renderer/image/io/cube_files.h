// SPDX-License-Identifier: Apache-2.0
// The files of a cube map in a folder, one for each face.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

namespace chromeball {

// The names of the files, without extension, end with px nx py ny pz nz, or posx negx ..., or right
// left top bottom front back; what is before that is the same in all six and ends with one of `_-.`
// or a space.
struct CubeFaces {
  std::array<std::filesystem::path, 6> files;  // +X -X +Y -Y +Z -Z
  bool namesAxes = false;                      // and not sides
};

// The one complete cube map in the folder. Throws InputError if there is none, or several.
CubeFaces findCubeFaces(const std::filesystem::path& folder);

// All files in the folder with names of faces; none if it is no folder.
std::vector<std::filesystem::path> cubeFilesIn(const std::filesystem::path& folder);

// Whether the file is one of at least five faces of a cube map in its folder.
bool isCubeFace(const std::filesystem::path& file);

}  // namespace chromeball
