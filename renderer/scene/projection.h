// SPDX-License-Identifier: Apache-2.0
// An image projected from a camera onto the surfaces that are visible to it.
#pragma once

#include <optional>

#include "image/image.h"
#include "scene/camera_view.h"

namespace chromeball {

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
