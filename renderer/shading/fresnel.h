// SPDX-License-Identifier: Apache-2.0
// Reflection and refraction at a smooth boundary. `eta`: the refractive index on the far side over
// that on the near side (the viewer's).
#pragma once

#include "math/vec.h"

namespace chromeball {

// Fresnel's equations: the fraction of unpolarised light that is reflected; 1 for total internal
// reflection. `cosine`: that of the angle of incidence, on the near side.
inline float fresnelDielectric(float cosine, float eta) {
  const float sin2 = (1 - cosine * cosine) / (eta * eta);  // on the far side, by Snell's law
  if (sin2 >= 1) return 1;
  const float beyond = std::sqrt(1 - sin2);
  const float s = (cosine - eta * beyond) / (cosine + eta * beyond);
  const float p = (eta * cosine - beyond) / (eta * cosine + beyond);
  return 0.5f * (s * s + p * p);
}

// Schlick's approximation (Schlick 1994, "An Inexpensive BRDF Model for Physically-based
// Rendering"), with the reflectance at normal and at grazing incidence.
template <class T>
T fresnelSchlick(const T& f0, const T& f90, float cosine) {
  const float c = 1 - cosine, c2 = c * c;
  return f0 + (f90 - f0) * (c2 * c2 * c);
}

// The direction (unit) in which light seen along wo is refracted at a facet with normal h
// (wo.h > 0), by Snell's law. Undefined for total internal reflection.
inline vec3 refracted(const vec3& wo, const vec3& h, float eta) {
  const float cosine = glm::dot(wo, h);
  const float beyond = std::sqrt(std::max(0.0f, 1 - (1 - cosine * cosine) / (eta * eta)));
  return -wo / eta + (cosine / eta - beyond) * h;
}

// Interference in a thin film on a surface (KHR_materials_iridescence).

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
