// SPDX-License-Identifier: Apache-2.0
// Triangles that lie in the same place as another.
#pragma once

#include <array>

#include "scene/surface.h"

namespace chromeball {

// A triangle with which others are compared: whether they come within a ray offset (rayOffset() of
// scene/surface.h) of its plane, over it.
class Coincidence {
 public:
  explicit Coincidence(const PlacedTriangle& triangle);

  // Whether a part of the other triangle that is wider than a few ray offsets coincides:
  // neighbours, which touch at an edge, and walls that cross in a line do not. Not for a triangle
  // without area.
  bool overlaps(const PlacedTriangle& other) const;

  // Whether any part may coincide, within twice the offset. `isNeighbour`: of the same mesh, which
  // may touch the edges.
  bool mayTouch(const PlacedTriangle& other, bool isNeighbour) const;

  // A sphere around the triangle.
  const vec3& centre() const { return centre_; }
  float radius() const { return radius_; }
  double offset() const { return offset_; }

 private:
  // The distance of a point on the inner side of an edge.
  double inside(const glm::dvec3& point, size_t edge) const {
    return glm::dot(point - corners_[edge], inwards_[edge]);
  }

  vec3 centre_;
  float radius_ = 0;
  double offset_;
  std::array<glm::dvec3, 3> corners_, inwards_;
  glm::dvec3 normal_;
};

}  // namespace chromeball
