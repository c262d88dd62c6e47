// SPDX-License-Identifier: Apache-2.0
#include "transport/vertex_arrays.h"

#include <limits>

namespace chromeball {
namespace {

using L = LanesOf<Float8>;
using Vector = Lanes3<Float8>;

Vector interpolated(const std::array<LaneArrays3, 3>& of, size_t i, Float8 u, Float8 v) {
  return (1 - u - v) * of[0].load(i) + u * of[1].load(i) + v * of[2].load(i);
}

// A length that is 0, too small or too large for the square of a float.
Int8 isExtreme(Float8 length2) {
  return ~((length2 >= std::numeric_limits<float>::min()) &
           (length2 <= std::numeric_limits<float>::max()));
}

Vector absolute(const Vector& v) {
  return {L::magnitude(v.x), L::magnitude(v.y), L::magnitude(v.z)};
}
Vector larger3(const Vector& a, const Vector& b) {
  return {larger(a.x, b.x), larger(a.y, b.y), larger(a.z, b.z)};
}

// As rayOffset() of scene/surface.h.
Float8 offsetOf(const Vector& p0, const Vector& p1, const Vector& p2, const Vector& normal) {
  constexpr float kRoundings = 32 * std::numeric_limits<float>::epsilon(), kAcross = 1.0f / 1024;
  const Vector extent = larger3(absolute(p0), larger3(absolute(p1), absolute(p2)));
  const Vector n = absolute(normal);
  return kRoundings * dot(Vector{n.x + kAcross, n.y + kAcross, n.z + kAcross}, extent);
}

}  // namespace

void VertexArrays::gather(const PlainSurfaces& plain, const HitArrays& hits, size_t count) {
  std::array<const PlainSurfaces::Part*, kMostInArrays> parts;
  std::array<const Triangle*, kMostInArrays> triangles;
  for (size_t k = 0; k < count; ++k) {
    parts[k] = &plain.part(size_t(hits.instance[k]));
    triangles[k] = parts[k]->triangles + hits.triangle[k];
    __builtin_prefetch(triangles[k]);
  }
  for (size_t k = 0; k < count; ++k)
    for (int i = 0; i < 3; ++i) {
      const uint32_t vertex = (*triangles[k])[i];
      __builtin_prefetch(parts[k]->positions + vertex);
      if (parts[k]->normals) __builtin_prefetch(parts[k]->normals + vertex);
    }
  for (size_t k = 0; k < count; ++k) {
    const PlainSurfaces::Part& part = *parts[k];
    hidesBack_[k] = part.hidesBack ? -1 : 0;
    isSingle_[k] = part.kind != PlainSurfaces::Kind::Uniform;
    if (isSingle_[k]) continue;
    set(k, plain.at(part.material));
    for (int i = 0; i < 3; ++i) {
      const uint32_t vertex = (*triangles[k])[i];
      corners_[size_t(i)].set(k, part.positions[vertex]);
      normals_[size_t(i)].set(k, part.normals ? part.normals[vertex] : vec3(0));
    }
  }
}

// The lanes of the last vector that are beyond the vertices: nothing reads the tables of metals.
void VertexArrays::clearTail(size_t count) {
  for (size_t k = count; k % L::kCount != 0; ++k) set(k, MaterialPoint{});
}

void VertexArrays::addLanes(size_t i, const RayArrays& rays, const HitArrays& hits) {
  const Vector p0 = corners_[0].load(i), p1 = corners_[1].load(i), p2 = corners_[2].load(i);
  const Float8 u = loadLanes(&hits.u[i]), v = loadLanes(&hits.v[i]);
  position.store(i, interpolated(corners_, i, u, v));
  Vector front = cross(p1 - p0, p2 - p0);
  const Float8 doubleArea2 = dot(front, front);
  front = (1 / L::squareRoot(doubleArea2)) * front;
  const Int8 isFront = dot(front, rays.direction.load(i)) <= 0;
  const Vector towards = chosen(isFront, front, L::splat(-1) * front);
  geometricNormal.store(i, towards);
  storeLanes(&rayOffset[i], offsetOf(p0, p1, p2, front));
  storeLanes(&isHidden[i], ~isFront & loadLanes(&hidesBack_[i]));

  Vector n = interpolated(normals_, i, u, v);
  const Float8 length2 = dot(n, n);
  n = (1 / L::squareRoot(length2)) * n;
  n = chosen(isFront, n, L::splat(-1) * n);
  normal.store(i, chosen(dot(n, towards) > 0, n, towards));
  const Int8 singly = isExtreme(doubleArea2) | (isExtreme(length2) & (length2 != 0));
  storeLanes(&isSingle_[i], loadLanes(&isSingle_[i]) | singly);
}

void VertexArrays::set(size_t i, const Surface& surface) {
  position.set(i, surface.position);
  geometricNormal.set(i, surface.geometricNormal);
  normal.set(i, surface.normal);
  rayOffset[i] = surface.rayOffset;
  isHidden[i] = !surface.frontFace ? hidesBack_[i] : 0;
}

void VertexArrays::set(size_t i, const MaterialPoint& material) {
  baseColor.set(i, material.baseColor);
  dielectricF0.set(i, material.dielectricF0);
  metallic[i] = material.metallic, roughness[i] = material.roughness;
  dielectricF90[i] = material.dielectricF90;
}

void VertexArrays::fill(const Scene& scene, const PlainSurfaces& plain, const RayArrays& rays,
                        const HitArrays& hits, std::span<const float> crossSections) {
  const size_t count = crossSections.size();
  gather(plain, hits, count);
  clearTail(count);
  for (size_t i = 0; i < count; i += L::kCount) addLanes(i, rays, hits);
  for (size_t k = 0; k < count; ++k) {
    if (!isSingle_[k]) [[likely]]
      continue;
    Surface& surface = surfaces_[k];
    surface =
        surfaceAt(scene, scene.instances[size_t(hits.instance[k])], uint32_t(hits.triangle[k]),
                  {hits.u[k], hits.v[k]}, -rays.direction.at(k), crossSections[k]);
    set(k, surface);
    set(k, materialAt(scene, surface));
  }
}

}  // namespace chromeball
