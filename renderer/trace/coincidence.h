// SPDX-License-Identifier: Apache-2.0
// Triangles that lie in the same place as another.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <unordered_set>
#include <vector>

#include "scene/surface.h"
#include "trace/accel.h"

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

// Triangles that lie in the same place as an emitting one.

// The triangles of a scene, emitting or not, that coincide with an emitting one over some area, and
// these emitting triangles themselves. Which of the surfaces at such a place a ray hits is
// arbitrary, so that paths and light samples must ask what a path meets there (transport/place.h).
// A few others may be among them.
class SharedPlaces {
 public:
  explicit SharedPlaces(const Accel& accel);

  bool contains(uint32_t instance, uint32_t triangle) const {
    return all_ || (!triangles_.empty() && triangles_.contains(keyOf(instance, triangle)));
  }

 private:
  static uint64_t keyOf(uint32_t instance, uint32_t triangle) {
    return uint64_t(instance) << 32 | triangle;
  }
  void addPartnersOf(const Accel& accel, uint32_t instance, uint32_t triangle, float time,
                     std::atomic<int64_t>& budget);

  bool all_ = false;
  std::mutex mutex_;  // of triangles_, while they are found
  std::unordered_set<uint64_t> triangles_;
};

// Triangles of glass with which no other surface coincides.

// A path that passes a surface must look for others in the same place (Accel::forEachCoincident()).
// For the triangles of materials that transmit, this remembers that there are none: each is looked
// at once, when a path first comes to it.
class LoneTriangles {
 public:
  // The structure must outlive this.
  explicit LoneTriangles(const Accel& accel);

  // Whether no other surface comes within the reach of Accel::forEachCoincident() of the triangle.
  // False for those that are not remembered. Thread-safe.
  bool contains(uint32_t instance, uint32_t triangle) const {
    const size_t first = firsts_.empty() ? kNone : firsts_[instance];
    if (first == kNone) return false;
    std::atomic<State>& state = states_[first + triangle];
    const State known = state.load(std::memory_order_relaxed);
    if (known != State::Unknown) [[likely]]
      return known == State::Lone;
    const bool isLone = !touchesOthers(instance, triangle);
    state.store(isLone ? State::Lone : State::Touching, std::memory_order_relaxed);
    return isLone;
  }

 private:
  enum class State : uint8_t { Unknown, Lone, Touching };
  static constexpr size_t kNone = size_t(-1);

  bool touchesOthers(uint32_t instance, uint32_t triangle) const;

  const Accel& accel_;
  std::vector<size_t> firsts_;  // by instance: of its triangles; kNone: not remembered
  mutable std::vector<std::atomic<State>> states_;
};

}  // namespace chromeball
