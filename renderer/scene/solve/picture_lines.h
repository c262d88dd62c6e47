// SPDX-License-Identifier: Apache-2.0
// Draws a model's edges and picked points over a photograph.
#pragma once

#include <span>

#include "image/image.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace chromeball {

// Lines and marks over a picture, antialiased; positions in pixels from its top left corner.
class PictureLines {
 public:
  // Lines are a fixed fraction of the picture's diagonal wide. `picture` must outlive this.
  explicit PictureLines(Image& picture);

  void line(glm::dvec2 from, glm::dvec2 to, const Rgb& color);
  void cross(const glm::dvec2& at, const Rgb& color);
  void circle(const glm::dvec2& at, const Rgb& color);

 private:
  double markSize() const { return 6 * width_; }

  Image& picture_;
  double width_;
};

struct ModelEdge {
  vec3 from, to;  // scene coordinates
};

// The borders of a model's surfaces, and the edges at which they bend by more than 30 degrees.
std::vector<ModelEdge> creases(const Scene& scene);

// What the camera sees of the edges, also of those that surfaces hide.
void drawEdges(std::span<const ModelEdge> edges, const Camera& camera, const Rgb& color,
               Image& picture);

}  // namespace chromeball
