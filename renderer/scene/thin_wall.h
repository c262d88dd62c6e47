// SPDX-License-Identifier: Apache-2.0
// Smooth thin sheets (KHR_materials_transmission): light passes them in a straight line, so that
// shadow rays can pass them, too.
#pragma once

#include "scene/extended_surface.h"

namespace chromeball {

// Whether the material transmits light only in a straight line, so that straightTransmittance() is
// all of its transmission.
bool passesStraight(const Material& material);

// Fraction of the light that passes a smooth sheet at an angle of the given cosine: the part that
// is not reflected (Schlick's Fresnel term), tinted by the base colour.
Rgb sheetTransmittance(const MaterialPoint& material, float transmission, float cosine);

// The same at a surface point, along `direction` (unit, of either sign); black for other materials.
Rgb straightTransmittance(const Scene& scene, const Instance& instance, const Surface& surface,
                          const vec3& direction);

}  // namespace chromeball
