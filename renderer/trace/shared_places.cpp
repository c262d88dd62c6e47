// SPDX-License-Identifier: Apache-2.0
#include "trace/shared_places.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <vector>

#include "base/parallel.h"

namespace chromeball {
namespace {

using glm::dvec3;
using Corners = std::array<vec3, 3>;

// A triangle with corners cut off by up to five planes.
class ClippedTriangle {
 public:
  explicit ClippedTriangle(const Corners& corners) : count_(3) {
    for (size_t i = 0; i < 3; ++i) points_[i] = dvec3(corners[i]);
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
double largestOffset(const Corners& corners) {
  return double(rayOffset(corners[0], corners[1], corners[2], vec3(1)));
}

// A triangle that is compared with others.
class Base {
 public:
  explicit Base(const Corners& corners) : offset_(largestOffset(corners)) {
    for (size_t i = 0; i < 3; ++i) corners_[i] = dvec3(corners[i]);
    normal_ = glm::normalize(glm::cross(corners_[1] - corners_[0], corners_[2] - corners_[0]));
    for (size_t i = 0; i < 3; ++i)
      inwards_[i] = glm::normalize(glm::cross(normal_, corners_[(i + 1) % 3] - corners_[i]));
  }

  // Whether a part of the other triangle that is wider than a few ray offsets lies within an offset
  // of this one: neighbours touch at an edge, and walls cross in a line. Not for a triangle without
  // area.
  bool coincides(const Corners& other) const {
    constexpr double kNarrow = 8;  // in offsets
    const std::array<dvec3, 3> points{dvec3(other[0]), dvec3(other[1]), dvec3(other[2])};
    const auto areAll = [&](const auto& condition) {
      return condition(points[0]) && condition(points[1]) && condition(points[2]);
    };
    for (size_t i = 0; i < 3; ++i)  // neighbours, most of all
      if (areAll([&](const dvec3& p) { return inside(p, i) < offset_; })) return false;
    const double offset = std::max(offset_, largestOffset(other));
    const auto height = [&](const dvec3& p) { return glm::dot(p - corners_[0], normal_); };
    if (areAll([&](const dvec3& p) { return height(p) > offset; }) ||
        areAll([&](const dvec3& p) { return height(p) < -offset; }))
      return false;
    ClippedTriangle part(other);
    for (size_t i = 0; i < 3; ++i)
      if (!part.clip([&](const dvec3& p) { return inside(p, i); })) return false;
    for (const double side : {-1.0, 1.0})
      if (!part.clip([&](const dvec3& p) { return offset - side * height(p); })) return false;
    return part.area() > kNarrow * offset * part.length();
  }

 private:
  // The distance of a point on the inner side of an edge.
  double inside(const dvec3& point, size_t edge) const {
    return glm::dot(point - corners_[edge], inwards_[edge]);
  }

  double offset_;
  std::array<dvec3, 3> corners_, inwards_;
  dvec3 normal_;
};

}  // namespace

// `time`: when the places are compared. `budget`: the remaining number of comparisons, which it
// reduces.
void SharedPlaces::addPartnersOf(const Accel& accel, uint32_t instance, uint32_t triangle,
                                 float time, std::atomic<int64_t>& budget) {
  const Scene& scene = accel.scene();
  const auto corners = [&](uint32_t i, uint32_t t) {
    const Instance& placed = scene.instances[i];
    return cornersAt(scene, placed, scene.meshes[size_t(placed.mesh)].triangles[t], time);
  };
  const Corners own = corners(instance, triangle);
  const Base base(own);
  const vec3 centre = (own[0] + own[1] + own[2]) / 3.0f;
  float radius = 0;
  for (const vec3& corner : own) radius = std::max(radius, glm::length(corner - centre));
  accel.forEachNear(centre, radius, time, [&](uint32_t i, uint32_t t) {
    if ((i != instance || t != triangle) && base.coincides(corners(i, t))) {
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

}  // namespace chromeball
