// SPDX-License-Identifier: Apache-2.0
#include "math/polygon.h"

#include <numeric>

#include "base/error.h"

namespace chromeball {
namespace {

// Twice the area of the triangle; positive if counter-clockwise.
double turn(const dvec2& a, const dvec2& b, const dvec2& c) { return cross(b - a, c - a); }

bool isBetween(const dvec2& a, const dvec2& b, const dvec2& p) {
  return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}

bool segmentsTouch(const dvec2& a, const dvec2& b, const dvec2& c, const dvec2& d) {
  const double c1 = turn(a, b, c), d1 = turn(a, b, d), a1 = turn(c, d, a), b1 = turn(c, d, b);
  if (((c1 > 0) != (d1 > 0)) && ((a1 > 0) != (b1 > 0)) && c1 != 0 && d1 != 0 && a1 != 0 && b1 != 0)
    return true;
  return (c1 == 0 && isBetween(a, b, c)) || (d1 == 0 && isBetween(a, b, d)) ||
         (a1 == 0 && isBetween(c, d, a)) || (b1 == 0 && isBetween(c, d, b));
}

bool triangleContains(const dvec2& a, const dvec2& b, const dvec2& c, const dvec2& p) {
  return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

constexpr double kLeastCosine = 0.17364817766693033;  // of 80 degrees

// The part of `v` that is perpendicular to the unit vector `axis`, normalised.
dvec3 perpendicular(const dvec3& v, const dvec3& axis) {
  return glm::normalize(v - glm::dot(v, axis) * axis);
}

}  // namespace

double signedArea(std::span<const dvec2> polygon) {
  double twice = 0;
  for (size_t i = 0; i < polygon.size(); ++i)
    twice += cross(polygon[i] - polygon[0], polygon[(i + 1) % polygon.size()] - polygon[0]);
  return twice / 2;
}

std::optional<std::string_view> whyNotSimple(std::span<const dvec2> polygon) {
  const size_t count = polygon.size();
  if (count < 3) return "has fewer than three corners";
  const auto at = [&](size_t i) { return polygon[i % count]; };
  for (size_t i = 0; i < count; ++i) {
    if (at(i) == at(i + 1)) return "has a corner twice";
    if (turn(at(i), at(i + 1), at(i + 2)) == 0 &&
        glm::dot(at(i + 1) - at(i), at(i + 2) - at(i + 1)) < 0)
      return "turns back on itself";
    for (size_t k = i + 2; k < count; ++k)
      if (k + 1 - i != count && segmentsTouch(at(i), at(i + 1), at(k), at(k + 1)))
        return "has edges that cross or touch";
  }
  if (signedArea(polygon) == 0) return "has no area";
  return {};
}

bool contains(std::span<const dvec2> polygon, const dvec2& p) {
  bool inside = false;
  for (size_t i = 0, before = polygon.size() - 1; i < polygon.size(); before = i++) {
    const dvec2 &a = polygon[i], &b = polygon[before];
    if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x)
      inside = !inside;
  }
  return inside;
}

std::vector<std::array<size_t, 3>> triangulate(std::span<const dvec2> polygon) {
  std::vector<size_t> left(polygon.size());
  std::iota(left.begin(), left.end(), size_t(0));
  std::vector<std::array<size_t, 3>> triangles;
  const auto isEar = [&](size_t i) {
    const size_t n = left.size(), a = left[(i + n - 1) % n], b = left[i], c = left[(i + 1) % n];
    if (!(turn(polygon[a], polygon[b], polygon[c]) > 0)) return false;
    return std::ranges::none_of(left, [&](size_t k) {
      return k != a && k != b && k != c &&
             triangleContains(polygon[a], polygon[b], polygon[c], polygon[k]);
    });
  };
  while (left.size() > 3) {
    size_t ear = 0;
    while (ear < left.size() && !isEar(ear)) ++ear;
    if (ear == left.size()) ear = 0;  // rounding: what is left has almost no area
    const size_t n = left.size();
    triangles.push_back({left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
    left.erase(left.begin() + ptrdiff_t(ear));
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

std::vector<dvec2> convexHull(std::vector<dvec2> points) {
  std::ranges::sort(points, [](const dvec2& a, const dvec2& b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<dvec2> hull;
  const auto extend = [&](const dvec2& p, size_t first) {
    while (hull.size() >= first + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0)
      hull.pop_back();
    hull.push_back(p);
  };
  for (const dvec2& p : points) extend(p, 0);
  const size_t upper = hull.size() - 1;
  for (size_t i = points.size() - 1; i-- > 0;) extend(points[i], upper);
  hull.pop_back();
  return hull;
}

SphericalPolygon::SphericalPolygon(const std::vector<dvec3>& corners, const std::string& location)
    : corners_(corners) {
  if (corners.size() < 3 || corners.size() > kMaxCorners)
    throwInput("{}: a polygon has 3 to {} corners, not {}", location, kMaxCorners, corners.size());
  axis_ = dvec3(0);
  for (const dvec3& corner : corners) axis_ += corner;
  axis_ = glm::length(axis_) > 1e-9 ? glm::normalize(axis_) : corners.front();
  if (std::ranges::any_of(corners,
                          [&](const dvec3& c) { return glm::dot(c, axis_) < kLeastCosine; }))
    throwInput("{}: the polygon reaches more than 80 degrees from its middle; divide it", location);
  x_ = perpendicular(std::fabs(axis_.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0), axis_);
  y_ = glm::cross(axis_, x_);
  for (const dvec3& corner : corners_) plane_.push_back(projected(corner));
  if (const auto reason = whyNotSimple(plane_)) throwInput("{}: the polygon {}", location, *reason);
  if (signedArea(plane_) < 0) {
    std::ranges::reverse(corners_);
    std::ranges::reverse(plane_);
  }
  for (const auto& [i, j, k] : triangulate(plane_))
    solidAngle_ += triangles_.emplace_back(corners_[i], corners_[j], corners_[k]).solidAngle;
}

dvec2 SphericalPolygon::projected(const dvec3& direction) const {
  return dvec2(glm::dot(direction, x_), glm::dot(direction, y_)) / glm::dot(direction, axis_);
}

bool SphericalPolygon::contains(const dvec3& direction) const {
  return glm::dot(direction, axis_) > 0 && chromeball::contains(plane_, projected(direction));
}

double SphericalPolygon::chordTo(const dvec3& direction) const {
  if (contains(direction)) return 0;
  double least = 2;
  for (size_t i = 0; i < corners_.size(); ++i) {
    const dvec3 &a = corners_[i], &b = corners_[(i + 1) % corners_.size()];
    least = std::min(least, glm::distance(direction, a));
    const dvec3 normal = glm::normalize(glm::cross(a, b));
    const dvec3 foot = direction - glm::dot(direction, normal) * normal;
    const bool isBetween =
        glm::dot(glm::cross(a, foot), normal) > 0 && glm::dot(glm::cross(foot, b), normal) > 0;
    if (isBetween) least = std::min(least, glm::distance(direction, glm::normalize(foot)));
  }
  return least;
}

// A cap of less than 90 degrees is convex: it contains the great circles between its points.
double SphericalPolygon::capRadius() const {
  double least = 1;
  for (const dvec3& corner : corners_) least = std::min(least, glm::dot(corner, axis_));
  return std::acos(std::min(least, 1.0));
}

dvec3 SphericalPolygon::vectorIrradiance() const {
  dvec3 sum(0);
  for (size_t i = 0; i < corners_.size(); ++i) {
    const dvec3 normal = glm::cross(corners_[i], corners_[(i + 1) % corners_.size()]);
    const double sine = glm::length(normal);
    const double cosine = glm::dot(corners_[i], corners_[(i + 1) % corners_.size()]);
    if (sine > 0) sum += normal * (std::atan2(sine, cosine) / sine);
  }
  return 0.5 * sum;
}

dvec3 SphericalPolygon::sample(double u, double v) const {
  double target = u * solidAngle_;
  size_t i = 0;
  while (i + 1 < triangles_.size() && target >= triangles_[i].solidAngle)
    target -= triangles_[i++].solidAngle;
  return triangles_[i].sample(std::clamp(target / triangles_[i].solidAngle, 0.0, 1.0), v);
}

// The solid angle by van Oosterom and Strackee (1983).
SphericalPolygon::Triangle::Triangle(const dvec3& p, const dvec3& q, const dvec3& r)
    : a(p), b(q), c(r) {
  const double triple = std::fabs(glm::dot(a, glm::cross(b - a, c - a)));
  cosC = glm::dot(a, b);
  solidAngle = 2 * std::atan2(triple, 1 + cosC + glm::dot(b, c) + glm::dot(c, a));
  const dvec3 ab = glm::cross(a, b), ac = glm::cross(a, c);
  alpha = std::atan2(glm::length(glm::cross(ab, ac)), glm::dot(ab, ac));
}

dvec3 SphericalPolygon::Triangle::sample(double u, double v) const {
  constexpr double kFlat = 1e-7;  // sr; below, the plane of the corners is as good, and accurate
  if (solidAngle < kFlat) {
    const double root = std::sqrt(u);
    return glm::normalize(a * (1 - root) + root * (b * (1 - v) + c * v));
  }
  // Arvo, "Stratified Sampling of Spherical Triangles": a triangle (a, b, point on the side a c) of
  // the area u x solidAngle, then a point between b and that.
  const double s = std::sin(u * solidAngle - alpha), t = std::cos(u * solidAngle - alpha);
  const double sinAlpha = std::sin(alpha), cosAlpha = std::cos(alpha);
  const double p = t - cosAlpha, q = s + sinAlpha * cosC;
  const double below = (q * s + p * t) * sinAlpha;
  const double cosine =
      below != 0 ? std::clamp(((q * t - p * s) * cosAlpha - q) / below, -1.0, 1.0) : 1;
  const dvec3 onSide = cosine * a + std::sqrt(1 - cosine * cosine) * perpendicular(c, a);
  const double z = 1 - v * (1 - glm::dot(onSide, b));
  const dvec3 away = onSide - glm::dot(onSide, b) * b;
  const double length = glm::length(away);
  if (!(length > 0)) return b;
  return glm::normalize(z * b + std::sqrt(std::max(0.0, 1 - z * z)) * (away / length));
}

}  // namespace chromeball
