// SPDX-License-Identifier: Apache-2.0
// Interference in a thin film on a surface (KHR_materials_iridescence).
#pragma once

#include "math/vec.h"

namespace chromeball {

// Reflectance of a film of index `filmIor` and `thickness` nanometres on a base of reflectance
// `baseF0` at normal incidence in air, for the angle of incidence with cosine `cosine`. The first
// two orders of Airy's sum, with the eye's sensitivity integrated in Fourier space (Belcour and
// Barla 2017, "A Practical Extension to Microfacet Theory for the Modeling of Varying
// Iridescence"), as in the extension; but with Fresnel's equations between air and film, since with
// Schlick's approximation a film of index 1 would reflect light.
Rgb thinFilmReflectance(const Rgb& baseF0, float filmIor, float thickness, float cosine);

// The F0 for which Schlick's approximation (F90 = 1) gives the film's reflectance at this cosine,
// for use in a metallic-roughness lobe.
Rgb thinFilmF0(const Rgb& baseF0, float filmIor, float thickness, float cosine);

}  // namespace chromeball
