// SPDX-License-Identifier: Apache-2.0
// Smooth sheets without thickness (KHR_materials_transmission): light passes them in a straight
// line, so that shadow rays need not stop there.
#pragma once

#include "scene/extended_surface.h"

namespace chromeball {

// Whether what a material transmits goes straight on, and straightTransmittance() is all of it.
bool passesStraight(const Material& material);

// Share of the light that passes a smooth sheet under the given cosine: what its surface does not
// reflect (Schlick's Fresnel term), tinted by the base colour.
Rgb sheetTransmittance(const MaterialPoint& material, float transmission, float cosine);

// The same at a point of a scene, along `direction` (unit, either way); black for other materials.
Rgb straightTransmittance(const Scene& scene, const Instance& instance, const Surface& surface,
                          const vec3& direction);

}  // namespace chromeball
