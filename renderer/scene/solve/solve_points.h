// SPDX-License-Identifier: Apache-2.0
// The camera of a photograph by points of known positions.
#pragma once

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
// solve a linear problem; the best go on by the Levenberg-Marquardt method. The errors are those of
// the covariance s^2 (J^T J)^-1, with s^2 the squares' sum over the degrees of freedom. Throws
// InputError, begun by `file` or by the location of a point, if the points are too few, coincide or
// lie on a line, if no camera sees all of them in front of it, if they leave the camera open, and
// if the distortion found folds the image.
CameraFit solveByPoints(const std::vector<ObservedPoint>& points, const CameraKnowledge& known,
                        const std::string& file);

}  // namespace chromeball
