// SPDX-License-Identifier: Apache-2.0
// A picture thrown from a camera onto the surfaces that it sees.
#pragma once

#include <optional>

#include "image/image.h"
#include "scene/camera.h"

namespace chromeball {

class Projection {
 public:
  // For pictures of width x height pixels. Nothing is seen yet.
  Projection(const Camera& camera, int width, int height);

  // The farthest point that each pixel sees, in metres along the camera's axis; 0 for none (one
  // channel). Each pixel is made to see as far as its neighbours do, since a surface at a slant is
  // deeper at a pixel's far side than any point of it that was found.
  void setDepth(const Image& farthest);

  // The colour of the pixel in which the camera sees `point`; nullopt where something is before it.
  std::optional<Rgb> lookup(const vec3& point) const;

  Image& colors() { return colors_; }
  const Image& colors() const { return colors_; }
  bool sees(int x, int y) const { return *depth_.at(x, y) > 0; }

 private:
  bool orthographic_;
  vec3 position_, forward_;
  vec3 across_, down_;  // to pixels, from metres at depth 1
  Image colors_, depth_;
};

}  // namespace chromeball
