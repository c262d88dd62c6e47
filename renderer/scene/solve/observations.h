// SPDX-License-Identifier: Apache-2.0
// What somebody picked in a photograph: points of known positions, and lines along the axes.
//
// Image positions are in pixels from the photograph's top left corner, x right and y down: pixel
// (i, j) covers [i, i + 1) x [j, j + 1).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "math/vec.h"

namespace chromeball {

// No coordinate or length, in metres or pixels, may be larger: the squares of 1e160 overflow.
inline constexpr double kLargestCoordinate = 1e9;

struct ObservedPoint {
  std::string name, location;  // location: FILE:LINE, begins an error
  glm::dvec3 position;         // metres
  glm::dvec2 pixel;
};

// An edge parallel to an axis of the scene.
struct ObservedLine {
  std::string location;          // FILE:LINE
  int axis;                      // 0 x, 1 y, 2 z
  glm::dvec2 from, to;           // from one point to another farther along the positive axis
  std::optional<double> length;  // between them, in metres, if it is known; > 0
};

// CSV with a line for each, with or without these names as first line; # begins a comment:
//   name,x,y,z,px,py
//   axis,x1,y1,x2,y2,metres       metres may be empty or missing
// Throws InputError "FILE:LINE: ..." for other columns, for what is not a finite number, and for a
// name that occurs twice.
std::vector<ObservedPoint> readObservedPoints(const std::filesystem::path& path);
std::vector<ObservedLine> readObservedLines(const std::filesystem::path& path);

}  // namespace chromeball
