// SPDX-License-Identifier: Apache-2.0
// Interference in a thin film on a surface (KHR_materials_iridescence).
#pragma once

#include "math/vec.h"

namespace chromeball {

// Reflectance under the cosine `cosine` of a film of index `filmIor`, `thickness` nanometres thick,
// on a base of reflectance `baseF0` at normal incidence in air. Airy's sum of the first two orders,
// with the eye's sensitivity integrated in Fourier space: Belcour and Barla 2017, "A Practical
// Extension to Microfacet Theory for the Modeling of Varying Iridescence", as the extension has it;
// but by Fresnel's equations where air meets the film, since Schlick's let a film of air reflect.
Rgb thinFilmReflectance(const Rgb& baseF0, float filmIor, float thickness, float cosine);

// The F0 with which Schlick's Fresnel term (F90 = 1) gives the film's reflectance under this
// cosine: the film as a metallic-roughness lobe knows it.
Rgb thinFilmF0(const Rgb& baseF0, float filmIor, float thickness, float cosine);

}  // namespace chromeball
