// SPDX-License-Identifier: Apache-2.0
// Irradiance that a probe puts on surfaces of any orientation.
#pragma once

#include <span>
#include <vector>

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

// E(n) = sum over texels of radiance x max(0, n . m), W/m^2 from W/(m^2 sr), one for each of
// `normals` (unit), for a finite lat-long map whose texels are constant (Madsen and Laursen 2007,
// eq. 1 to 4). m is the integral of direction over the texel, so the sum is the exact integral but
// for the texels that n's horizon cuts: of those it sees a little too little, h^2/12 of E for a
// constant map whose texels are h radians wide (3e-6 at 1024 x 512). Rounding adds less than 1e-6
// of the largest E. Uses all cores; the same bits for any number of them.
std::vector<dvec3> exactIrradiance(const Image& latLong, std::span<const vec3> normals);

// The same from nine spherical harmonics: fast, 1 to 10% off on real probes
// (spherical_harmonics.h), and negative some 120 degrees away from suns.
std::vector<dvec3> shIrradiance(const Image& latLong, std::span<const vec3> normals);

// The directions of the texel centres of a lat-long map, row by row: the normals of a map of
// irradiance.
std::vector<vec3> texelDirections(const ImageSize& latLong);

// Lat-long maps of irradiance, three channels, at the normals above.
Image irradianceMap(const Image& latLong, const ImageSize& size);
Image shIrradianceMap(const Image& latLong, const ImageSize& size);

}  // namespace chromeball
