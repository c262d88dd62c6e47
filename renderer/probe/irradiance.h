// SPDX-License-Identifier: Apache-2.0
// Irradiance from a probe on surfaces of any orientation.
#pragma once

#include <span>
#include <vector>

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

// E(n) = sum over texels of radiance x max(0, n . m), in W/m^2, for each of `normals` (unit)
// (Madsen and Laursen 2007, eq. 1 to 4). `latLong` is finite and constant over each texel; m is the
// integral of direction over the texel. So the sum is the exact integral except for texels cut by
// the horizon of n, whose light it underestimates: by h^2/12 of E for a constant map whose texels
// are h radians wide (3e-6 at 1024 x 512). Rounding adds less than 1e-6 of the largest E. Parallel;
// the same bits for any number of threads.
std::vector<dvec3> exactIrradiance(const Image& latLong, std::span<const vec3> normals);

// The same from nine spherical harmonics: fast, with an error of 1 to 10% on real probes
// (spherical_harmonics.h), and negative about 120 degrees away from suns.
std::vector<dvec3> shIrradiance(const Image& latLong, std::span<const vec3> normals);

// The directions of the texel centres of a lat-long map, row by row: the normals of an irradiance
// map.
std::vector<vec3> texelDirections(const ImageSize& latLong);

// Lat-long irradiance maps at those normals, three channels.
Image irradianceMap(const Image& latLong, const ImageSize& size);
Image shIrradianceMap(const Image& latLong, const ImageSize& size);

}  // namespace chromeball
