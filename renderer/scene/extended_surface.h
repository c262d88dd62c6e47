// SPDX-License-Identifier: Apache-2.0
// The parameters of a material's extensions at a surface point: factors times textures.
#pragma once

#include "scene/surface.h"

namespace chromeball {

inline constexpr float kCoatF0 = 0.04f;  // of a clear coat with refractive index 1.5

struct ExtendedPoint {
  float transmission = 0;
  bool thinWalled = true;
  float clearcoat = 0, clearcoatRoughness = 0;
  Rgb sheenColor{0};
  float sheenRoughness = 0;
  float anisotropy = 0;
  vec3 anisotropyTangent{0};  // unit, perpendicular to the smooth normal
  float iridescence = 0, filmIor = 1, filmThickness = 0;  // nanometres
  vec3 clearcoatNormal{0};                                // unit, on the viewer's side
};

// Precondition: the surface's material has extensions.
ExtendedPoint extendedMaterialAt(const Scene& scene, const Instance& instance,
                                 const Surface& surface);

// Whether the surface is the inner side of a body's boundary. Coats and sheen lie on the outer
// side.
inline bool isInsideBody(const Surface& surface, const ExtendedPoint& point) {
  return point.transmission > 0 && !point.thinWalled && !surface.frontFace;
}

// Fraction of the light emitted towards `wo` that passes the clear coat (KHR_materials_clearcoat):
// 1 - clearcoat F, with Schlick's Fresnel term F at the coat's normal. Precondition: the surface's
// material has extensions.
float coatTransmittance(const Scene& scene, const Instance& instance, const Surface& surface,
                        const vec3& wo);

}  // namespace chromeball
