// SPDX-License-Identifier: Apache-2.0
// The camera of a photograph by points of known positions, or by lines along the axes of the scene.
#pragma once

#include <optional>
#include <vector>

#include "math/vec.h"
#include "scene/solve/observations.h"
#include "scene/solve/solved_camera.h"

namespace chromeball {

struct CameraKnowledge {
  ImageSize size{};                        // of the photograph
  glm::dvec2 principalPoint{0.5};          // as Camera::principalPoint
  std::optional<double> focalLength = {};  // in pixels; nullopt: to be found
  bool findsDistortion = false;            // k1
};

// The fewest points: 4 for position and rotation, 6 if the focal length is to be found too.
size_t fewestPoints(const CameraKnowledge& known);

// The camera with the least sum of squared distances, in pixels, between the points and where it
// sees them (HDRI book, 9.7). The starting points are spread over all rotations, so that no guess
// is needed and that a second solution is found (CameraFit::rivalRms): for each, the other unknowns
// solve a linear problem; the Levenberg-Marquardt method refines the best. The errors follow from
// the covariance s^2 (J^T J)^-1, with s^2 the squares' sum over the degrees of freedom. Throws
// InputError, begun by `file` or by the location of a point, if the points are too few, coincide or
// lie on a line, if no camera sees all of them in front of it, if they do not determine the camera,
// and if the distortion found folds the image.
CameraFit solveByPoints(const std::vector<ObservedPoint>& points, const CameraKnowledge& known,
                        const std::string& file);

// The data that place the camera, once its rotation is known. The ground is the plane y = 0.
struct LinePlacement {
  std::optional<double> height = {};      // of the camera above the ground, metres, > 0
  std::optional<glm::dvec2> origin = {};  // the pixel that shows (0, 0, 0)
};

// Rotation and focal length from at least two axes with two lines each: lines along an axis meet at
// its vanishing point (HDRI book, 9.7). Minimises the squared distances of the lines' ends from
// lines through their middles to the vanishing points, which the three axes share at right angles.
// The order of the ends tells the direction of an axis.
//
// Position: the scale comes from the height, or from the lines of known length, whose first ends
// must be on the ground. The origin is the given pixel, else the first end of the first line of
// known length, else below the camera. CameraErrors has no position.
//
// Throws InputError, begun by `file` or by the location of a line, if the lines are too few, do not
// fit any focal length or contradict each other in order, if nothing tells the scale, and if a
// point of the ground is above the horizon.
CameraFit solveByLines(const std::vector<ObservedLine>& lines, const CameraKnowledge& known,
                       const LinePlacement& placement, const std::string& file);

}  // namespace chromeball
