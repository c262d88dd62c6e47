// SPDX-License-Identifier: Apache-2.0
// Rays that meet a triangle so close to its edge that rounding decides which side of it they pass.
#pragma once

#include <algorithm>
#include <optional>

#include "scene/scene.h"
#include "trace/ray.h"

namespace chromeball {

// Whether `aimedInside` may have an answer: a cheap test that few hits pass. It overlooks edges of
// triangles that the ray sees so small, or so nearly edge-on, that rounding is a hundredth of their
// height: 25 um from 1 m.
inline bool isBesideEdge(const Hit& hit) {
  const vec2& b = hit.barycentric;
  return std::min({b.x, b.y, 1 - b.x - b.y}) < 0.01f;
}

// Where two triangles of a body share an edge and one stands before the other, a ray that grazes
// the edge can miss the near one by a rounding and meet the far one from behind: from inside the
// body, whose light would leak out. The ray turned, by a few roundings, to meet the triangle of
// `hit` clear of its edges, where whatever stands before it is met first. None where the hit is
// clear already, or so near that this would turn the ray by more than 1e-3.
std::optional<Ray> aimedInside(const Scene& scene, const Ray& ray, const Hit& hit);

}  // namespace chromeball
