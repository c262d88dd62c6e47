// SPDX-License-Identifier: Apache-2.0
// How geometry and lamps move while the shutter is open. Time is in [0, 1], from its opening to its
// closing; keys are at equally spaced times, the first at 0 and the last at 1.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "math/vec.h"
#include "scene/mesh.h"

namespace chromeball {

// An affine transform. Row r of the matrix is (linear[0][r], linear[1][r], linear[2][r],
// translation[r]).
struct Transform {
  glm::mat3 linear{1};
  vec3 translation{0};

  vec3 point(const vec3& p) const { return linear * p + translation; }
  // The sizes of the products that point() adds, which its rounding errors are relative to.
  vec3 reach(const vec3& p) const {
    const vec3 size = absolute(p);
    return absolute(linear[0]) * size.x + absolute(linear[1]) * size.y +
           absolute(linear[2]) * size.z + absolute(translation);
  }
  bool operator==(const Transform&) const = default;
};

// The effect of a node's transform on surfaces: glTF allows scales of 0, which flatten a solid to a
// plane figure.

inline constexpr double kSingular = 1e-9;  // relative to the lengths of the columns

// Whether the matrix is invertible, also after rounding to float.
inline bool isInvertible(const glm::dmat3& map) {
  const glm::dmat3 m(glm::mat3{map});
  const double volume = glm::length(m[0]) * glm::length(m[1]) * glm::length(m[2]);
  return std::isfinite(volume) && std::fabs(glm::determinant(m)) > kSingular * volume;
}

// Whether a mesh that the map places may be traced as an instance, for which rays are transformed
// back: coordinates up to 1e9 m then stay within Embree's, 1.8e18, and small ones do not underflow.
inline constexpr double kMostInstanceScale = 1e8;
inline bool canPlaceInstance(const glm::dmat3& map) {
  if (!isInvertible(map)) return false;
  const glm::dmat3 back = glm::inverse(map);
  for (int i = 0; i < 3; ++i)
    if (!(std::max(glm::length(map[i]), glm::length(back[i])) <= kMostInstanceScale)) return false;
  return true;
}

// Whether the map leaves some surface an area: at least two of the axes' images span one.
inline bool leavesArea(const glm::dmat3& map) {
  const glm::dmat3 m(glm::mat3{map});
  const auto spans = [&](int i, int j) {
    const double area = glm::length(m[i]) * glm::length(m[j]);
    return std::isfinite(area) && glm::length(glm::cross(m[i], m[j])) > kSingular * area;
  };
  return std::isfinite(glm::length(m[0]) + glm::length(m[1]) + glm::length(m[2])) &&
         (spans(0, 1) || spans(1, 2) || spans(2, 0));
}

// Whether triangles must be wound the other way for their front faces to stay front faces. A
// flattening transform does not mirror: the sign of its determinant comes from rounding errors.
inline bool mirrors(const glm::dmat3& map) {
  return glm::determinant(map) < 0 && isInvertible(map);
}

// The transform of normals: the inverse transpose. If the transform flattens, the limit of that up
// to a factor: the cofactors, which map all normals to the plane's normal, on the side of the
// triangles' fronts; they are projected on it, so that normals along the plane do not become
// rounding errors.
inline glm::dmat3 normalMatrix(const glm::dmat3& m) {
  if (isInvertible(m)) return glm::transpose(glm::inverse(m));
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]),
                             glm::cross(m[0], m[1]));
  glm::dvec3 plane(0);
  for (int i = 0; i < 3; ++i)
    if (glm::length(cofactors[i]) > glm::length(plane)) plane = cofactors[i];
  return glm::outerProduct(plane, plane * cofactors);
}

inline constexpr int kMostMotionSteps = 128;  // between two keys each; Embree's limit

// The two keys around a time, and the fraction of the way from the first to the second.
struct KeySpan {
  size_t from, to;
  float fraction;
};
inline KeySpan keysAround(size_t keys, float time) {
  const float position = std::clamp(time, 0.0f, 1.0f) * float(keys - 1);
  const size_t from = std::min(size_t(position), keys - 2);
  return {from, from + 1, position - float(from)};
}

// The motion of an instance. Between two keys its vertices move along straight lines, as Embree
// moves them. All meshes have the same triangles.
struct InstanceMotion {
  struct Key {
    MeshList::Shared mesh;
    std::optional<Transform> toWorld;

    vec3 point(uint32_t vertex) const {
      const vec3& p = mesh->positions[vertex];
      return toWorld ? toWorld->point(p) : p;
    }
    bool operator==(const Key&) const = default;
  };
  std::vector<Key> keys;  // at least 2

  KeySpan at(float time) const { return keysAround(keys.size(), time); }
  vec3 point(uint32_t vertex, const KeySpan& span) const {
    return glm::mix(keys[span.from].point(vertex), keys[span.to].point(vertex), span.fraction);
  }
  // Whether the mesh keeps its shape, so that only its transform moves.
  bool isRigid() const {
    return std::ranges::all_of(keys, [&](const Key& k) { return k.mesh == keys.front().mesh; });
  }
};

}  // namespace chromeball
