// SPDX-License-Identifier: Apache-2.0
// Irradiance from a probe on surfaces of any orientation.
#pragma once

#include <span>
#include <vector>

#include "image/image.h"
#include "math/rotation.h"
#include "probe/mapping.h"

namespace chromeball {

// E(n) = integral over all directions of radiance x max(0, n . direction), in W/m^2, for each of
// `normals` (unit) (Madsen and Laursen 2007, eq. 1 to 4). `latLong` is finite and constant over
// each texel, of any size. In azimuth the integral is exact; in the polar angle the horizon of n
// cuts a row, at least 1/128 of the map high, where it cuts its mean direction: too little light,
// by at most 6e-5 of E for a constant map. Rounding adds less than 1e-12 of the largest E.
// Parallel; the same bits for any number of threads.
std::vector<dvec3> exactIrradiance(const Image& latLong, std::span<const vec3> normals);

// The same from nine spherical harmonics: fast, with an error of 1 to 10% on real probes
// (spherical_harmonics.h), and negative about 120 degrees away from suns.
std::vector<dvec3> shIrradiance(const Image& latLong, std::span<const vec3> normals);

// The directions of the texel centres of a lat-long map, row by row: the normals of an irradiance
// map.
std::vector<vec3> texelDirections(const ImageSize& latLong);

// The same of the environment that `rotation` turns: directions in the map, which is not turned.
std::vector<vec3> texelDirections(const ImageSize& latLong, const Rotation& rotation);

// Three channels; one colour a texel, row by row.
Image imageOf(const ImageSize& size, std::span<const dvec3> colors);

// Lat-long irradiance maps at those normals, three channels, of the environment that `rotation`
// turns.
Image irradianceMap(const Image& latLong, const ImageSize& size, const Rotation& rotation = {});
Image shIrradianceMap(const Image& latLong, const ImageSize& size, const Rotation& rotation = {});

}  // namespace chromeball
