// SPDX-License-Identifier: Apache-2.0
// The camera of a photograph by lines along the axes of the scene.
#pragma once

#include <optional>
#include <vector>

#include "math/vec.h"
#include "scene/solve/solve_points.h"

namespace chromeball {

// What places the camera, once its rotation is known. The ground is the plane y = 0.
struct LinePlacement {
  std::optional<double> height = {};      // of the camera above the ground, metres, > 0
  std::optional<glm::dvec2> origin = {};  // the pixel that shows (0, 0, 0)
};

// Rotation and focal length from at least two axes with two lines each: lines along an axis meet at
// its vanishing point (HDRI book, 9.7). Minimises the squared distances of the lines' ends from
// lines through their middles to the vanishing points, which the three axes share at right angles.
// The order of the ends tells the direction of an axis.
//
// Position: the scale is that of the height, or of the lines of known length, whose first ends must
// be on the ground. The origin is the given pixel, else the first end of the first line of known
// length, else below the camera. CameraErrors has no position.
//
// Throws InputError, begun by `file` or by the location of a line, if the lines are too few, do not
// fit any focal length or contradict each other in order, if nothing tells the scale, and if a
// point of the ground is above the horizon.
CameraFit solveByLines(const std::vector<ObservedLine>& lines, const CameraKnowledge& known,
                       const LinePlacement& placement, const std::string& file);

}  // namespace chromeball
