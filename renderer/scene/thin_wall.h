// SPDX-License-Identifier: Apache-2.0
// Smooth thin sheets (KHR_materials_transmission). They do not refract, so shadow rays can pass
// them.
#pragma once

#include "scene/extended_surface.h"

namespace chromeball {

// Whether the material transmits light only in a straight line, so that straightTransmittance() is
// its whole transmission.
bool passesStraight(const Material& material);

// Transmittance of a smooth sheet for the given cosine of the angle of incidence: base colour x
// transmission x (1 - metallic) x (1 - Schlick's Fresnel term).
Rgb sheetTransmittance(const MaterialPoint& material, float transmission, float cosine);

// The same at a surface point, along `direction` (unit, either sign); black unless
// passesStraight().
Rgb straightTransmittance(const Scene& scene, const Instance& instance, const Surface& surface,
                          const vec3& direction);

}  // namespace chromeball
