// SPDX-License-Identifier: Apache-2.0
// Geometry, normals and material parameters at a hit point.
#pragma once

#include <algorithm>
#include <array>

#include "scene/scene.h"

namespace chromeball {

// A point on a triangle. Both normals are unit and on the side of the viewer; `normal` is the
// shading normal: interpolated, and perturbed by the material's normal map if it has one.
struct Surface {
  const Mesh* mesh;
  const Material* material;
  Triangle triangle;
  vec2 barycentric;  // weights of the second and third vertex
  vec3 position;
  vec3 geometricNormal;
  vec3 normal;
  float rayOffset;  // offset of ray origins from the surface against self-intersection, metres
  bool frontFace;
  // Area of the texture filter on the triangle, divided by twice the triangle's area; 0 if textures
  // are not filtered.
  float footprint;
  float time = 0;  // at which it is seen (scene/motion.h)

  // Origin of a ray that leaves the surface in direction `direction`.
  vec3 rayOrigin(const vec3& direction) const {
    const float side = glm::dot(geometricNormal, direction) < 0 ? -rayOffset : rayOffset;
    return position + side * geometricNormal;
  }
};

// The corners of a triangle in world space, in the order of its vertices.
std::array<vec3, 3> cornersAt(const Scene& scene, const Instance& instance,
                              const Triangle& triangle, float time);

// A triangle in world space, with the sizes of the coordinates that rounding errors of its points
// are relative to. Those of an instance may exceed the corners: a mesh far from its own origin may
// be placed near that of the world.
struct PlacedTriangle {
  std::array<vec3, 3> corners;
  vec3 sizes;
};
PlacedTriangle placedTriangle(const Scene& scene, const Instance& instance, uint32_t triangle,
                              float time);

// The offset of ray origins from a triangle with coordinates of these sizes and this unit normal,
// metres.
float rayOffset(const vec3& sizes, const vec3& normal);

// Whether a ray along `direction` hits the back of the triangle; equals !surfaceAt().frontFace.
bool isFromBehind(const Scene& scene, const Instance& instance, uint32_t triangle,
                  const vec3& direction, float time = 0);

// `wo`: unit, towards the viewer. `crossSection`: that of the beam around the ray, in square
// metres; 0 without texture filtering.
Surface surfaceAt(const Scene& scene, const Instance& instance, uint32_t triangle, vec2 barycentric,
                  const vec3& wo, float crossSection = 0, float time = 0);

// These fetch into the cache what surfaceAt() reads: the triangle, then its vertices.
inline void prefetchTriangle(const Scene& scene, const Instance& instance, uint32_t triangle) {
  __builtin_prefetch(&scene.meshes[size_t(instance.mesh)].triangles[triangle]);
}
inline void prefetchVertices(const Scene& scene, const Instance& instance, uint32_t triangle) {
  const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
  const Triangle& t = mesh.triangles[triangle];
  for (const uint32_t vertex : {t.x, t.y, t.z}) {
    __builtin_prefetch(&mesh.positions[vertex]);
    if (!mesh.normals.empty()) __builtin_prefetch(&mesh.normals[vertex]);
  }
}

// The orthonormal frame of normal maps: the interpolated normal (not mapped), tangent and
// bitangent, on the front side. nullopt if the mesh has no tangents or the tangent is degenerate.
struct TangentFrame {
  vec3 tangent, bitangent, normal;
};
std::optional<TangentFrame> tangentFrameAt(const Surface& surface, const Instance& instance);

// The unit normal given by a normal map.
vec3 mappedNormal(const Scene& scene, const TextureSlot& map, float scale, const Surface& surface,
                  const TangentFrame& frame);

// The texture's value at a surface point.
vec4 lookup(const Scene& scene, const TextureSlot& slot, const Surface& surface);

// The metallic-roughness parameters at a point: factors x textures x vertex colours.
struct MaterialPoint {
  Rgb baseColor;
  float metallic, roughness;
  Rgb dielectricF0;     // of the dielectric part: reflectance at normal incidence
  float dielectricF90;  // reflectance at grazing incidence
};
MaterialPoint materialAt(const Scene& scene, const Surface& surface);

// Radiance emitted towards `wo` (unit, on the viewer's side). A single-sided material emits only
// from its front; a clear coat attenuates the emission by coatTransmittance().
Rgb emittedRadiance(const Scene& scene, const Instance& instance, const Surface& surface,
                    const vec3& wo);

// Coverage at a point: 1 for opaque surfaces, 0 or 1 for masks, in between for blended ones.
float surfaceAlpha(const Scene& scene, const Instance& instance, uint32_t triangle,
                   vec2 barycentric);

// Turns the shading normal towards the geometric one as far as needed for the mirror direction of
// wo to leave the surface: smooth normals on coarse meshes would otherwise leave black rims (Keller
// et al. 2017, "The Iray Light Transport Simulation and Rendering System").
inline vec3 normalThatReflects(const vec3& normal, const vec3& geometricNormal, const vec3& wo) {
  const vec3 mirrored = 2 * glm::dot(normal, wo) * normal - wo;
  const float height = glm::dot(mirrored, geometricNormal);
  const float minimum = 0.1f * std::min(glm::dot(wo, geometricNormal), 1.0f);
  if (height >= minimum) return normal;
  const vec3 lifted = glm::normalize(mirrored + (minimum - height) * geometricNormal);
  return glm::normalize(lifted + wo);
}

}  // namespace chromeball
