// SPDX-License-Identifier: Apache-2.0
// What a ray finds where it hits: geometry, normals, and the material's parameters at that point.
#pragma once

#include "scene/scene.h"

namespace chromeball {

// A point on a triangle. Both normals are unit and on the side of the viewer; `normal` is the
// interpolated (and, where the material has one, mapped) shading normal.
struct Surface {
  const Mesh* mesh;
  const Material* material;
  Triangle triangle;
  vec2 barycentric;  // weights of the second and third vertex
  vec3 position;
  vec3 geometricNormal;
  vec3 normal;
  float rayOffset;  // how far a ray must start off the surface not to meet it again (metres)
  bool frontFace;
  // The area around the point that stands for it in textures, as a share of twice the triangle's; 0
  // where textures are not filtered.
  float footprint;

  // Where a ray that leaves towards `direction` starts.
  vec3 rayOrigin(const vec3& direction) const {
    const float side = glm::dot(geometricNormal, direction) < 0 ? -rayOffset : rayOffset;
    return position + side * geometricNormal;
  }
};

// Whether a ray along `direction` meets the back of a triangle: surfaceAt() says the same.
bool isFromBehind(const Scene& scene, const Instance& instance, uint32_t triangle,
                  const vec3& direction);

// `wo`: unit, towards the viewer. `crossSection`: of the beam around the ray, in square metres; 0
// for a ray that sees a point.
Surface surfaceAt(const Scene& scene, const Instance& instance, uint32_t triangle, vec2 barycentric,
                  const vec3& wo, float crossSection = 0);

// The smooth normal before any map, and the axes about it that normal maps are written in, all on
// the front. Right angles; unit. Nothing where the mesh has no tangents or a degenerate one.
struct TangentFrame {
  vec3 tangent, bitangent, normal;
};
std::optional<TangentFrame> tangentFrameAt(const Surface& surface, const Instance& instance);

// A normal map's normal, unit.
vec3 mappedNormal(const Scene& scene, const TextureSlot& map, float scale, const Surface& surface,
                  const TangentFrame& frame);

// A texture's value at a surface.
vec4 lookup(const Scene& scene, const TextureSlot& slot, const Surface& surface);

// The metallic-roughness parameters at a point: factors x textures x vertex colours.
struct MaterialPoint {
  Rgb baseColor;
  float metallic, roughness;
  Rgb dielectricF0;     // reflectance at normal incidence of the dielectric part
  float dielectricF90;  // and at grazing incidence
};
MaterialPoint materialAt(const Scene& scene, const Surface& surface);

// Radiance emitted towards `wo` (unit, on the side that the surface is seen from). A single-sided
// material emits from its front only; a clear coat keeps back what it reflects.
Rgb emittedRadiance(const Scene& scene, const Instance& instance, const Surface& surface,
                    const vec3& wo);

// Coverage at a point: 1 for opaque surfaces, 0 or 1 for masks, in between for blended ones.
float surfaceAlpha(const Scene& scene, const Instance& instance, uint32_t triangle,
                   vec2 barycentric);

}  // namespace chromeball
