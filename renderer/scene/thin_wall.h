// SPDX-License-Identifier: Apache-2.0
// Surfaces that shadow rays pass: smooth thin sheets (KHR_materials_transmission), which do not
// refract, and, as an approximation, smooth bodies of glass as if they did not.
#pragma once

#include <span>

#include "scene/extended_surface.h"

namespace chromeball {

// Whether the material transmits light only in a straight line, so that straightTransmittance() is
// its whole transmission.
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
// passesShadows().
Rgb straightTransmittance(const Scene& scene, const Instance& instance, const Surface& surface,
                          const vec3& direction);

}  // namespace chromeball
