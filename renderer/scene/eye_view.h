// SPDX-License-Identifier: Apache-2.0
// What an eye within the scene sees in all directions.
#pragma once

#include <array>
#include <vector>

#include "scene/bounds.h"
#include "scene/scene.h"

namespace chromeball {

struct Sight {
  glm::dvec3 direction;        // unit
  double distance = INFINITY;  // of the nearest surface, metres; infinite: none
  glm::dvec3 normal{0};        // unit, of its front
  bool showsBack = false;      // the back of a single-sided surface, which is no wall of a room

  bool isWall() const { return distance < INFINITY && !showsBack; }
};

// The nearest surfaces of the instances (indices into scene.instances) in 320 directions spread
// evenly over the sphere. O(triangles).
std::vector<Sight> sightsFrom(const Scene& scene, const std::vector<int>& instances,
                              const glm::dvec3& eye);

// The view of a building from outside.

// The nearest surfaces seen along one axis, from both sides of a box, sampled by a grid of kCells^2
// parallel rays.
class AxisView {
 public:
  static constexpr int kCells = 64;  // per side of the grid

  AxisView(int axis, const Bounds& box)
      : axis_(axis), origin_(box.min), cellsPerMetre_(double(kCells) / box.size()) {}

  void add(const std::array<glm::dvec3, 3>& triangle);
  // Adds a view of later triangles; among surfaces at one height the first counts.
  void add(const AxisView& later);

  // Adds the number of back faces and of all faces that are visible from the two sides.
  void count(double& backFaces, double& faces) const;

  // Whether nothing hides the point from the upper (+) or the lower side of the axis, except
  // surfaces so near that they may be its own.
  bool shows(const glm::dvec3& point, bool fromUpperSide) const;

 private:
  struct Cell {
    double high = -INFINITY, low = INFINITY;
    bool highIsFront = true, lowIsFront = true;
  };
  glm::dvec3 toCells(const glm::dvec3& point) const { return (point - origin_) * cellsPerMetre_; }

  int axis_;
  glm::dvec3 origin_, cellsPerMetre_;
  std::vector<Cell> cells_ = std::vector<Cell>(size_t(kCells) * kCells);
};

// The views, by axis, of the instances (indices into scene.instances) from the sides of their
// bounding box, which must have an extent along each axis. O(triangles), on all threads.
using OutsideViews = std::array<AxisView, 3>;
OutsideViews outsideViews(const Scene& scene, const std::vector<int>& instances, const Bounds& box);

// Whether the views show mostly back faces: single-sided walls that face inwards.
bool faceInwards(const OutsideViews& views);

}  // namespace chromeball
