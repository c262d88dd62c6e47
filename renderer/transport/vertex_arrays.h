// SPDX-License-Identifier: Apache-2.0
// Points of plain surfaces in arrays.
#pragma once

#include <span>

#include "math/lanes.h"
#include "shading/bsdf_lanes.h"
#include "trace/hit_arrays.h"
#include "transport/plain_surfaces.h"

namespace chromeball {

// Surface and MaterialPoint of the vertices of several paths. Keeps its arrays, for many calls.
class VertexArrays {
 public:
  // Fills the arrays for the first `count` hits, all of plain instances. `crossSections`: of the
  // beams, as for surfaceAt().
  void fill(const Scene& scene, const PlainSurfaces& plain, const RayArrays& rays,
            const HitArrays& hits, std::span<const float> crossSections);

  LaneArrays3 position, geometricNormal, normal;
  alignas(64) LaneArray<float> rayOffset;
  alignas(64) LaneArray<int32_t> isHidden;  // -1: a back that the camera and mirrors do not see
  LaneArrays3 baseColor, dielectricF0;
  alignas(64) LaneArray<float> metallic, roughness, dielectricF90;

  MaterialLanes material(size_t i) const {
    return {baseColor.load(i), loadLanes(&metallic[i]), loadLanes(&roughness[i]),
            dielectricF0.load(i), loadLanes(&dielectricF90[i])};
  }
  // Of a vertex of a part that emits.
  const Surface& surface(size_t i) const { return surfaces_[i]; }
  Ray rayFrom(size_t i, const vec3& direction, float tMax) const {
    const vec3 n = geometricNormal.at(i);
    const float offset = glm::dot(n, direction) < 0 ? -rayOffset[i] : rayOffset[i];
    return {position.at(i) + offset * n, direction, tMax, 0};
  }
  // As Surface::rayOrigin().
  Lanes3<Float8> rayOrigin(size_t i, const Lanes3<Float8>& direction) const {
    const Lanes3<Float8> n = geometricNormal.load(i);
    const Float8 offset = loadLanes(&rayOffset[i]);
    return position.load(i) + (dot(n, direction) < 0 ? -offset : offset) * n;
  }

 private:
  void gather(const PlainSurfaces& plain, const HitArrays& hits, size_t count);
  void clearTail(size_t count);
  void addLanes(size_t i, const RayArrays& rays, const HitArrays& hits);
  void set(size_t i, const Surface& surface);
  void set(size_t i, const MaterialPoint& material);

  std::array<LaneArrays3, 3> corners_, normals_;  // of the triangles
  alignas(64) LaneArray<int32_t> hidesBack_;
  alignas(64) LaneArray<int32_t> isSingle_;      // not 0: by surfaceAt() and materialAt()
  std::array<Surface, kMostInArrays> surfaces_;  // of these
};

}  // namespace chromeball
