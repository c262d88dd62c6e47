// SPDX-License-Identifier: Apache-2.0
// Polygons on the unit sphere, with great circles as edges.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "math/vec.h"

namespace chromeball {

// Simple polygons in the plane.

using glm::dvec2;

double signedArea(std::span<const dvec2> polygon);  // positive if counter-clockwise

// The reason why the polygon is not simple; nullopt if it is: at least three vertices, an area, and
// no edges that touch, except neighbours at their vertex. Takes time in proportion to the square of
// their number.
std::optional<std::string_view> whyNotSimple(std::span<const dvec2> polygon);

// Tests by the even-odd rule; points on edges belong to either side.
bool contains(std::span<const dvec2> polygon, const dvec2& point);

// Indices of the vertices of triangles that together cover a simple counter-clockwise polygon (ear
// clipping).
std::vector<std::array<size_t, 3>> triangulate(std::span<const dvec2> polygon);

// The convex hull, counter-clockwise, without vertices on its edges (Andrew 1979).
std::vector<dvec2> convexHull(std::vector<dvec2> points);

using glm::dvec3;

// A simple polygon within a hemisphere. In the gnomonic projection about a direction inside that
// hemisphere great circles are straight lines, so that it is a polygon of the plane.
class SphericalPolygon {
 public:
  static constexpr size_t kMaxCorners = 64;

  // The corners are unit directions, in either order around the polygon. Throws InputError, a
  // reason that starts with `location`, for another number of corners, and for a polygon that is
  // not simple or not within a cone of 80 degrees about the mean of its corners.
  SphericalPolygon(const std::vector<dvec3>& corners, const std::string& location);

  const std::vector<dvec3>& corners() const { return corners_; }  // counter-clockwise from inside
  double solidAngle() const { return solidAngle_; }
  bool contains(const dvec3& direction) const;
  double chordTo(const dvec3& direction) const;  // the shortest, on the unit sphere; 0 inside

  // The cap that contains the polygon.
  const dvec3& axis() const { return axis_; }
  double capRadius() const;  // radians, at most 80 degrees

  // The vector irradiance of unit radiance (Lambert 1760): 1/2 sum over edges of (angle of the
  // edge) x (unit normal of its plane). Its product with a surface's normal is the irradiance
  // there, if the whole polygon is above the horizon.
  dvec3 vectorIrradiance() const;

  // A direction uniform over the solid angle, pdf 1 / solidAngle() (Arvo 1995); all numbers in [0,
  // 1).
  dvec3 sample(double u, double v) const;

 private:
  struct Triangle {
    dvec3 a, b, c;
    double solidAngle;
    double cosC, alpha;  // cosine of the side a b, angle at a

    Triangle(const dvec3& p, const dvec3& q, const dvec3& r);
    dvec3 sample(double u, double v) const;
  };
  dvec2 projected(const dvec3& direction) const;

  std::vector<dvec3> corners_;
  dvec3 axis_, x_, y_;        // of the projection
  std::vector<dvec2> plane_;  // the projected corners
  std::vector<Triangle> triangles_;
  double solidAngle_ = 0;
};

}  // namespace chromeball
