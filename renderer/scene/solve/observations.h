// SPDX-License-Identifier: Apache-2.0
// Observations that somebody picked in a photograph: points of known positions, and lines along the
// axes.
//
// Image positions are in pixels from the photograph's top left corner, x right and y down: pixel
// (i, j) covers [i, i + 1) x [j, j + 1).
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "image/image.h"
#include "math/vec.h"
#include "scene/camera.h"
#include "scene/scene.h"

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
// Throws InputError "FILE:LINE: ..." for other columns, for a number that is not finite, and for a
// name that occurs twice.
std::vector<ObservedPoint> readObservedPoints(const std::filesystem::path& path);
std::vector<ObservedLine> readObservedLines(const std::filesystem::path& path);

// Draws a model's edges and picked points over a photograph.

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

// Draws the edges as the camera sees them, including edges that surfaces hide.
void drawEdges(std::span<const ModelEdge> edges, const Camera& camera, const Rgb& color,
               Image& picture);

}  // namespace chromeball
