// SPDX-License-Identifier: Apache-2.0
// The "Charlie" distribution of fibres that stand up from a surface, in the frame of the normal, +z
// (Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF").
#pragma once

#include "math/vec.h"

namespace chromeball::charlie {

// The fit of the masking term is poor below this perceptual roughness.
inline constexpr float kMinRoughness = 0.1f;

// f |cos| of the white lobe, for unit directions above the surface: D G2 / (4 wo.z). `alpha`: the
// square of perceptual roughness.
float fCos(const vec3& wo, const vec3& wi, float alpha);

}  // namespace chromeball::charlie
