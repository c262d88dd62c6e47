// SPDX-License-Identifier: Apache-2.0
#include "scene/choose_view.h"

#include <algorithm>

#include "base/parallel.h"
#include "math/icosphere.h"
#include "scene/placed_triangles.h"

namespace chromeball {
namespace {

using glm::dvec3;

// Sights ordered by height, so that a triangle needs to be tested only against a short range of
// them.
class EyeView {
 public:
  explicit EyeView(const dvec3& eye) : eye_(eye) {
    constexpr int kSubdivisions = 2;
    for (const vec3& direction : icosphereNormals(kSubdivisions))
      sights_.push_back({.direction = glm::normalize(dvec3(direction))});
    std::ranges::sort(sights_, {}, [](const Sight& s) { return s.direction.y; });
  }

  void add(const Corners& corners, bool isDoubleSided, int instance) {
    const dvec3 a = corners[0] - eye_, b = corners[1] - eye_, c = corners[2] - eye_;
    const dvec3 bc = glm::cross(b, c), ca = glm::cross(c, a), ab = glm::cross(a, b);
    const dvec3 normal = bc + ca + ab;
    const double volume = glm::dot(a, bc);
    if (!(glm::dot(normal, normal) > 0)) return;
    const auto [low, high] = heights(a, b, c);
    const auto height = [](const Sight& s) { return s.direction.y; };
    for (auto s = std::ranges::lower_bound(sights_, low, {}, height);
         s != sights_.end() && s->direction.y <= high; ++s) {
      const double u = glm::dot(s->direction, bc), v = glm::dot(s->direction, ca),
                   w = glm::dot(s->direction, ab);
      const bool isWithin = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
      const double distance = volume / (u + v + w);
      const bool showsBack = !isDoubleSided && u + v + w > 0;
      if (isWithin && distance > 0 && isNearer(distance, showsBack, *s))
        *s = {s->direction, distance, glm::normalize(normal), showsBack, instance};
    }
  }

  std::vector<Sight> take() { return std::move(sights_); }

 private:
  // Between a front and a back at the same place (walls modelled by two coincident surfaces), the
  // front counts as nearer.
  static bool isNearer(double distance, bool showsBack, const Sight& than) {
    constexpr double kSame = 1e-6;
    if (std::fabs(distance - than.distance) <= kSame * distance) return !showsBack;
    return distance < than.distance;
  }

  // Bounds of the heights of unit directions to the triangle, by its bounding sphere.
  static std::pair<double, double> heights(const dvec3& a, const dvec3& b, const dvec3& c) {
    constexpr double kRounding = 1e-6;
    const dvec3 centre = (a + b + c) / 3.0;
    const double radius =
        std::max({glm::length(a - centre), glm::length(b - centre), glm::length(c - centre)});
    const double distance = glm::length(centre);
    if (!(radius < distance)) return {-1, 1};
    const double elevation = std::asin(std::clamp(centre.y / distance, -1.0, 1.0));
    const double angle = std::asin(radius / distance) + kRounding;
    return {elevation - angle < -kPiD / 2 ? -1 : std::sin(elevation - angle),
            elevation + angle > kPiD / 2 ? 1 : std::sin(elevation + angle)};
  }

  dvec3 eye_;
  std::vector<Sight> sights_;
};

}  // namespace

std::vector<Sight> sightsFrom(const Scene& scene, const std::vector<int>& instances,
                              const dvec3& eye) {
  EyeView panorama(eye);
  forShownTriangles(scene, instances, [&](const Corners& c, int i) {
    const int material = scene.instances[size_t(i)].material;
    panorama.add(c, scene.materials[size_t(material)].doubleSided, i);
  });
  return panorama.take();
}

namespace {

using glm::dvec2;
using glm::dvec3;

void addInstance(const Scene& scene, const Instance& instance, const ShownTriangles& shown,
                 const OutsideViews& empty, OutsideViews& views) {
  constexpr size_t kGrain = 1 << 18;
  const bool isDoubleSided = scene.materials[size_t(instance.material)].doubleSided;
  const auto addTriangles = [&](size_t begin, size_t end, OutsideViews& to) {
    forTriangles(
        scene, instance, begin, end,
        [&](const Corners& c) {
          for (AxisView& view : to) view.add(c, isDoubleSided);
        },
        shown.step);
  };
  const auto join = [](OutsideViews& to, const OutsideViews& later) {
    for (size_t i = 0; i < to.size(); ++i) to[i].add(later[i]);
  };
  if (shown.count <= kGrain)
    addTriangles(0, shown.count, views);
  else
    join(views, joinRanges(shown.count, kGrain, empty, addTriangles, join));
}

}  // namespace

void AxisView::add(const Corners& corners, bool isDoubleSided) {
  const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
  std::array<dvec2, 3> p;  // u, v and the axis are right-handed
  for (size_t k = 0; k < 3; ++k) {
    const dvec3 corner = toCells(corners[k]);
    p[k] = {corner[u], corner[v]};
  }
  const dvec2 low = glm::min(p[0], glm::min(p[1], p[2])),
              high = glm::max(p[0], glm::max(p[1], p[2]));
  // The first cell whose centre may be covered.
  const dvec2 first = glm::clamp(glm::ceil(low - 0.5), dvec2(0), dvec2(kCells));
  if (!(first.x + 0.5 <= high.x && first.y + 0.5 <= high.y)) return;
  const double area = cross(p[1] - p[0], p[2] - p[0]);  // > 0: faces the upper side
  if (area == 0) return;
  for (int y = int(first.y); y < kCells && y + 0.5 <= high.y; ++y)
    for (int x = int(first.x); x < kCells && x + 0.5 <= high.x; ++x) {
      const dvec2 at(x + 0.5, y + 0.5);
      const double a = cross(p[1] - at, p[2] - at) / area, b = cross(p[2] - at, p[0] - at) / area;
      if (a < 0 || b < 0 || a + b > 1) continue;
      const double height =
          a * corners[0][axis_] + b * corners[1][axis_] + (1 - a - b) * corners[2][axis_];
      Cell& nearest = cells_[size_t(y * kCells + x)];
      if (height > nearest.high.height) nearest.high = {height, area < 0, isDoubleSided};
      if (height < nearest.low.height) nearest.low = {height, area > 0, isDoubleSided};
    }
}

void AxisView::add(const AxisView& later) {
  for (size_t i = 0; i < cells_.size(); ++i) {
    const Cell& other = later.cells_[i];
    Cell& nearest = cells_[i];
    if (other.high.height > nearest.high.height) nearest.high = other.high;
    if (other.low.height < nearest.low.height) nearest.low = other.low;
  }
}

void AxisView::count(Faces& faces) const {
  for (const Cell& nearest : cells_) {
    if (nearest.high.height < nearest.low.height) continue;
    for (const Face& face : {nearest.high, nearest.low}) {
      ++faces.all;
      faces.backs += face.isBack;
      faces.hiddenBacks += face.isBack && !face.isDoubleSided;
    }
  }
}

bool AxisView::shows(const dvec3& point, bool fromUpperSide) const {
  const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
  const dvec3 at = toCells(point);
  const int x = std::clamp(int(at[u]), 0, kCells - 1), y = std::clamp(int(at[v]), 0, kCells - 1);
  const double near = 2 * std::max(1 / cellsPerMetre_[u], 1 / cellsPerMetre_[v]);
  const Cell& nearest = cells_[size_t(y * kCells + x)];
  return fromUpperSide ? nearest.high.height <= point[axis_] + near
                       : nearest.low.height >= point[axis_] - near;
}

OutsideViews outsideViews(const Scene& scene, const std::vector<int>& instances,
                          const Bounds& box) {
  const OutsideViews empty{AxisView(0, box), AxisView(1, box), AxisView(2, box)};
  OutsideViews views = empty;
  for (const int i : instances) {
    endIfCancelled();
    const Instance& instance = scene.instances[size_t(i)];
    addInstance(scene, instance, {scene, instance, instances.size()}, empty, views);
  }
  return views;
}

AxisView::Faces facesOf(const OutsideViews& views) {
  AxisView::Faces faces;
  for (const AxisView& view : views) view.count(faces);
  return faces;
}

}  // namespace chromeball
