// SPDX-License-Identifier: Apache-2.0
#include "math/planar_polygon.h"

#include <algorithm>
#include <numeric>

namespace chromeball {
namespace {

double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

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

}  // namespace chromeball
