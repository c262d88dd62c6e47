// SPDX-License-Identifier: Apache-2.0
// The parameters of a material's extensions at a surface point: factors times textures.
#pragma once

#include <span>

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

// Surfaces that shadow rays pass: smooth thin sheets (KHR_materials_transmission), which do not
// refract, and, as an approximation, smooth bodies of glass, as if they did not refract either.

// Whether the material transmits light in a straight line, so that straightTransmittance() is its
// whole transmission: where a texture decides that, at the points that it makes smooth.
bool passesStraight(const Material& material);

// Sets Material::straightShadows of smooth bodies that are opaque (not masked or blended) and have
// no coat, sheen or film.
void passShadowsStraight(std::span<Material> materials);

inline bool passesShadows(const Material& material) {
  return material.straightShadows || passesStraight(material);
}

// Transmittance of a smooth sheet for the given cosine of the angle of incidence: base colour x
// transmission x (1 - metallic) x (1 - Schlick's Fresnel term).
Rgb sheetTransmittance(const MaterialPoint& material, float transmission, float cosine);

// The same at a surface point, along `direction` (unit, either sign); black unless
// passesShadows(), and where a texture makes the surface rough.
Rgb straightTransmittance(const Scene& scene, const Instance& instance, const Surface& surface,
                          const vec3& direction);

}  // namespace chromeball
