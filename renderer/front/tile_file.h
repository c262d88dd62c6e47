// SPDX-License-Identifier: Apache-2.0
// Lists of photographs and the directions of their camera (TOML), for `chromeball probe stitch`.
#pragma once

#include <string>
#include <vector>

#include "math/rotation.h"

namespace chromeball {

struct TileEntry {
  std::string file;  // from the working directory
  Rotation::Angles pose;
  double fov;            // vertical, degrees
  std::string location;  // FILE:LINE, begins an error
};

// fov = 50 (of tiles that give none), and [[tile]] tables with file, yaw, pitch, roll (0 if not
// given) and fov. Files are relative to the list. Throws InputError "FILE:LINE: ...".
std::vector<TileEntry> readTiles(const std::string& path);

// Writes the same list with other poses, in another folder. Throws RunError.
void writeTiles(const std::string& path, const std::vector<TileEntry>& tiles);

}  // namespace chromeball
