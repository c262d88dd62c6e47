// SPDX-License-Identifier: Apache-2.0
// The view that suits the shape of a scene.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "scene/bounds.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace chromeball {

// What an eye within the scene sees in all directions.

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

// The choice.

struct ChosenView {
  std::optional<Camera> inside;  // a room
  ViewAngles outside;
  bool isDark = false;  // Framing::isDark
};

// Of the instances (indices into scene.instances). From outside, the view is from the front,
// slightly above and to the right, but for
// - what lies in a plane, with its fronts on one side, or is thin and upright, such as a chart: it
//   is seen from its front;
// - what is flat and level: it is seen from higher above;
// - a box with one to three open sides, which is seen through these;
// - what is longer from front to back than one and a half times its width: it is seen from its
//   right side, towards its front.
// O(triangles).
ChosenView chooseView(const Scene& scene, const std::vector<int>& instances);

// Whether walls among `all` instances, single-sided and facing inwards, keep a probe's light from
// the middle of some of them; both ascend. O(triangles).
bool areShutIn(const Scene& scene, const std::vector<int>& instances, std::vector<int> all);

// A camera inside the room that the instances form; nullopt if they do not form a room. They do if
// front faces of walls surround some free position on all sides except for a window or a door,
// floor and furniture are below it, none of the four sides of the model is open, and one of these
// holds:
// - Seen from the six sides of the bounding box, 60% of the nearest surfaces are back faces: walls
//   that face inwards; the walls that are seen from the position are mostly planes of a few
//   directions, around a fifth or more of the box. (A body turned inside out has no such walls.)
// - The bounding box is 2 to 10 metres high and at least 2.5 metres wide, there are at least five
//   instances, and two are seen from the position: furniture within walls with two faces. (Size
//   and counts exclude cups and rows of them, whose walls also surround a free position.)
// The camera is at 55% of the height from floor to ceiling, at the position and in the direction
// from which it sees the largest area of a horizontal section through the room; under a roof, if
// there is one somewhere.
struct InteriorView {
  Camera camera;
  std::vector<Sight> sights;  // from its position
};
std::optional<InteriorView> interiorView(const Scene& scene, const std::vector<int>& instances,
                                         const Bounds& box, const OutsideViews& outside);

// The horizontal directions to the open sides of the model, through which most of the space that
// the eye sees, under a roof if it is under one, is visible from outside: their sum; empty if there
// are none.
std::optional<glm::dvec3> openSides(const std::vector<Sight>& sights, const glm::dvec3& eye,
                                    const Bounds& box, const OutsideViews& outside);

}  // namespace chromeball
