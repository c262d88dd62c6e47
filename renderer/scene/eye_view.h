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
  int instance = -1;           // of the surface: an index into scene.instances

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

  void add(const std::array<glm::dvec3, 3>& triangle, bool isDoubleSided);
  // Adds a view of later triangles; among surfaces at one height the first counts.
  void add(const AxisView& later);

  // The faces that are visible from the two sides.
  struct Faces {
    double all = 0, backs = 0, hiddenBacks = 0;  // hidden: of single-sided surfaces

    // Whether they show mostly back faces: walls that face inwards.
    bool areBacks() const { return backs > kMost * all; }
    bool hideBacks() const { return hiddenBacks > kMost * all; }

   private:
    static constexpr double kMost = 0.6;
  };
  void count(Faces& faces) const;

  // Whether nothing hides the point from the upper (+) or the lower side of the axis, except
  // surfaces so near that they may be its own.
  bool shows(const glm::dvec3& point, bool fromUpperSide) const;

 private:
  struct Face {
    double height;
    bool isBack = false, isDoubleSided = false;
  };
  struct Cell {
    Face high{-INFINITY}, low{INFINITY};
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

AxisView::Faces facesOf(const OutsideViews& views);

}  // namespace chromeball
