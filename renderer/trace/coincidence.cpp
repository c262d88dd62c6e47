// SPDX-License-Identifier: Apache-2.0
#include "trace/coincidence.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <vector>

#include "base/parallel.h"
#include "scene/surface.h"

namespace chromeball {
namespace {

using glm::dvec3;
using Points = std::array<dvec3, 3>;

// A triangle with corners cut off by up to five planes.
class ClippedTriangle {
 public:
  explicit ClippedTriangle(const Points& corners) : count_(3) {
    std::ranges::copy(corners, points_.begin());
  }

  // Keeps the part where height(point) > 0, linear in the point (Sutherland and Hodgman). Returns
  // false if nothing is left.
  template <class Height>
  bool clip(const Height& height) {
    const ClippedTriangle before = *this;
    count_ = 0;
    for (size_t i = 0; i < before.count_; ++i) {
      const dvec3 &from = before.points_[i], &to = before.points_[(i + 1) % before.count_];
      const double start = height(from), end = height(to);
      if (start > 0) points_[count_++] = from;
      if ((start > 0) != (end > 0)) points_[count_++] = from + start / (start - end) * (to - from);
    }
    return count_ > 0;
  }

  double area() const {
    dvec3 sum(0);
    for (size_t i = 2; i < count_; ++i)
      sum += glm::cross(points_[i - 1] - points_[0], points_[i] - points_[0]);
    return 0.5 * glm::length(sum);
  }
  // The distance from one corner to the farthest.
  double length() const {
    double longest = 0;
    for (size_t i = 1; i < count_; ++i)
      longest = std::max(longest, glm::length(points_[i] - points_[0]));
    return longest;
  }

 private:
  std::array<dvec3, 16> points_;  // each plane adds at most one, rounding perhaps another
  size_t count_;
};

// An offset that is at least rayOffset() for any normal.
double largestOffset(const PlacedTriangle& triangle) {
  return double(rayOffset(triangle.sizes, vec3(1)));
}

Points pointsOf(const PlacedTriangle& triangle) {
  return {dvec3(triangle.corners[0]), dvec3(triangle.corners[1]), dvec3(triangle.corners[2])};
}

template <class Condition>
bool holdsForAll(const Points& points, const Condition& condition) {
  return condition(points[0]) && condition(points[1]) && condition(points[2]);
}

constexpr size_t kMostRemembered = 64'000'000;  // a byte each

}  // namespace

Coincidence::Coincidence(const PlacedTriangle& triangle)
    : centre_((triangle.corners[0] + triangle.corners[1] + triangle.corners[2]) / 3.0f),
      offset_(largestOffset(triangle)),
      corners_(pointsOf(triangle)) {
  for (const vec3& corner : triangle.corners)
    radius_ = std::max(radius_, glm::length(corner - centre_));
  normal_ = glm::normalize(glm::cross(corners_[1] - corners_[0], corners_[2] - corners_[0]));
  for (size_t i = 0; i < 3; ++i)
    inwards_[i] = glm::normalize(glm::cross(normal_, corners_[(i + 1) % 3] - corners_[i]));
}

bool Coincidence::overlaps(const PlacedTriangle& other) const {
  constexpr double kNarrow = 8;  // in offsets
  const Points points = pointsOf(other);
  for (size_t i = 0; i < 3; ++i)  // neighbours, most of all
    if (holdsForAll(points, [&](const dvec3& p) { return inside(p, i) < offset_; })) return false;
  const double offset = std::max(offset_, largestOffset(other));
  const auto height = [&](const dvec3& p) { return glm::dot(p - corners_[0], normal_); };
  if (holdsForAll(points, [&](const dvec3& p) { return height(p) > offset; }) ||
      holdsForAll(points, [&](const dvec3& p) { return height(p) < -offset; }))
    return false;
  ClippedTriangle part(points);
  for (size_t i = 0; i < 3; ++i)
    if (!part.clip([&](const dvec3& p) { return inside(p, i); })) return false;
  for (const double side : {-1.0, 1.0})
    if (!part.clip([&](const dvec3& p) { return offset - side * height(p); })) return false;
  return part.area() > kNarrow * offset * part.length();
}

bool Coincidence::mayTouch(const PlacedTriangle& other, bool isNeighbour) const {
  const Points points = pointsOf(other);
  const double offset = 2 * std::max(offset_, largestOffset(other));
  const double margin = isNeighbour ? offset_ : -offset;  // of the edges, inwards
  ClippedTriangle part(points);
  for (size_t i = 0; i < 3; ++i)
    if (!part.clip([&](const dvec3& p) { return inside(p, i) - margin; })) return false;
  for (const double side : {-1.0, 1.0})
    if (!part.clip(
            [&](const dvec3& p) { return offset - side * glm::dot(p - corners_[0], normal_); }))
      return false;
  return true;
}

// `time`: when the places are compared. `budget`: the remaining number of comparisons, which it
// reduces.
void SharedPlaces::addPartnersOf(const Accel& accel, uint32_t instance, uint32_t triangle,
                                 float time, std::atomic<int64_t>& budget) {
  const Scene& scene = accel.scene();
  const auto placed = [&](uint32_t i, uint32_t t) {
    return placedTriangle(scene, scene.instances[i], t, time);
  };
  const Coincidence own(placed(instance, triangle));
  accel.forEachNear(own.centre(), own.radius(), time, [&](uint32_t i, uint32_t t) {
    if ((i != instance || t != triangle) && own.overlaps(placed(i, t))) {
      const std::scoped_lock lock(mutex_);
      triangles_.insert(keyOf(i, t));
      triangles_.insert(keyOf(instance, triangle));
    }
    return budget.fetch_sub(1, std::memory_order_relaxed) > 0;
  });
}

SharedPlaces::SharedPlaces(const Accel& accel) {
  const Scene& scene = accel.scene();
  // Surfaces that coincide for a while, not for a moment, do so at one of these times.
  std::vector<float> times{0};
  if (std::ranges::any_of(scene.instances, [](const Instance& i) { return i.motion != nullptr; }))
    times = {0, 0.25f, 0.5f, 0.75f, 1};
  // More comparisons would take seconds: beyond that, every triangle counts as sharing its place.
  std::atomic<int64_t> budget = 1'000'000 + 64 * int64_t(scene.triangleCount());
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Material& material = scene.materials[size_t(instance.material)];
    if (material.unlit || !material.emits()) continue;
    const auto count = uint32_t(scene.meshes[size_t(instance.mesh)].triangles.size());
    parallelFor(0u, count, [&](uint32_t t) {
      for (const float time : times)
        if (budget.load(std::memory_order_relaxed) > 0) addPartnersOf(accel, i, t, time, budget);
    });
  }
  all_ = budget <= 0;
}

LoneTriangles::LoneTriangles(const Accel& accel) : accel_(accel) {
  const Scene& scene = accel.scene();
  if (scene.moves) return;  // surfaces may coincide for a moment
  size_t count = 0;
  std::vector<size_t> firsts;
  for (const Instance& instance : scene.instances) {
    const size_t triangles = scene.meshes[size_t(instance.mesh)].triangles.size();
    const bool isGlass = scene.materials[size_t(instance.material)].transmits();
    const bool isKept = isGlass && count + triangles <= kMostRemembered;
    firsts.push_back(isKept ? count : kNone);
    if (isKept) count += triangles;
  }
  if (count == 0) return;
  firsts_ = std::move(firsts);
  states_ = std::vector<std::atomic<State>>(count);
}

bool LoneTriangles::touchesOthers(uint32_t instance, uint32_t triangle) const {
  const Scene& scene = accel_.scene();
  const auto placed = [&](uint32_t i, uint32_t t) {
    return placedTriangle(scene, scene.instances[i], t, 0);
  };
  const Coincidence own(placed(instance, triangle));
  const float reach = own.radius() + float(4 * own.offset());
  bool isTouched = false;
  accel_.forEachNear(own.centre(), reach, 0, [&](uint32_t i, uint32_t t) {
    isTouched |= (i != instance || t != triangle) && own.mayTouch(placed(i, t), i == instance);
    return !isTouched;
  });
  return isTouched;
}

}  // namespace chromeball
