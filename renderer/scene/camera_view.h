// SPDX-License-Identifier: Apache-2.0
// Where a camera shows points: the inverse of CameraRays.
#pragma once

#include <optional>

#include "image/image.h"
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

// An image projected from a camera onto the surfaces that are visible to it.

class Projection {
 public:
  // For images of width x height pixels; initially no surface is visible.
  Projection(const Camera& camera, int width, int height);

  // Sets the maximum depth of the surface visible in each pixel, in metres along the camera's axis;
  // 0: none (one channel). Applies a maximum filter over the neighbouring pixels, because samples
  // underestimate the maximum depth of an oblique surface.
  void setDepth(const Image& farthest);

  // The colour of the pixel that contains `point`; nullopt if the point is outside the image or
  // occluded.
  std::optional<Rgb> lookup(const vec3& point) const;

  Image& colors() { return colors_; }
  const Image& colors() const { return colors_; }
  bool sees(int x, int y) const { return *depth_.at(x, y) > 0; }

 private:
  CameraView view_;
  Image colors_, depth_;
};

}  // namespace chromeball
