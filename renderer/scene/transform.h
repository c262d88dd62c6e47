// SPDX-License-Identifier: Apache-2.0
// Affine transforms.
#pragma once

#include <cmath>

#include "math/vec.h"

namespace chromeball {

// Row r of the matrix is (linear[0][r], linear[1][r], linear[2][r], translation[r]).
struct Transform {
  glm::mat3 linear{1};
  vec3 translation{0};

  vec3 point(const vec3& p) const { return linear * p + translation; }
  bool operator==(const Transform&) const = default;
};

// What a transform of a node does to surfaces: glTF allows scales of 0, which flatten a solid to a
// plane figure.

inline constexpr double kSingular = 1e-9;  // relative to the lengths of the columns

// Whether the matrix is invertible, also after rounding to float.
inline bool isInvertible(const glm::dmat3& map) {
  const glm::dmat3 m(glm::mat3{map});
  const double volume = glm::length(m[0]) * glm::length(m[1]) * glm::length(m[2]);
  return std::isfinite(volume) && std::fabs(glm::determinant(m)) > kSingular * volume;
}

// Whether it leaves an area of some surface: of its images of the axes, two at least have one.
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
// flattening transform does not mirror: the sign of its determinant is that of rounding errors.
inline bool mirrors(const glm::dmat3& map) {
  return glm::determinant(map) < 0 && isInvertible(map);
}

// For normals: the inverse transpose. If the transform flattens, its limit up to a factor, the
// cofactors, which map all normals to that of the plane, on the side of the triangles' fronts; they
// are projected on it, so that those along the plane do not become rounding errors.
inline glm::dmat3 normalMatrix(const glm::dmat3& m) {
  if (isInvertible(m)) return glm::transpose(glm::inverse(m));
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]),
                             glm::cross(m[0], m[1]));
  glm::dvec3 plane(0);
  for (int i = 0; i < 3; ++i)
    if (glm::length(cofactors[i]) > glm::length(plane)) plane = cofactors[i];
  return glm::outerProduct(plane, plane * cofactors);
}

}  // namespace chromeball
