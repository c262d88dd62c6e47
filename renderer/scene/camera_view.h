// SPDX-License-Identifier: Apache-2.0
// Where a camera shows points: the inverse of CameraRays.
#pragma once

#include <optional>

#include "scene/camera.h"

namespace chromeball {

class CameraView {
 public:
  CameraView(const Camera& camera, double aspectRatio);

  // The image position (u right, v down; the image is [0, 1]^2) and the depth in metres along the
  // camera's axis; nullopt behind a perspective camera, and where the lens's picture has folded
  // back (Distortion::fold).
  struct Point {
    glm::dvec2 position;
    double depth;
  };
  std::optional<Point> at(const glm::dvec3& point) const;

 private:
  bool orthographic_;
  glm::dvec3 position_;
  glm::dmat3 toCamera_;
  glm::dvec2 axis_, scale_;  // image position of the axis; image sizes per metre at depth 1
  Distortion distortion_;
  double fold_;
};

}  // namespace chromeball
