// SPDX-License-Identifier: Apache-2.0
// How many random rays the irradiance of an unoccluded surface needs.
#pragma once

#include <span>
#include <vector>

#include "image/image.h"
#include "math/vec.h"

namespace chromeball {

// One ray estimates the irradiance E (of luminance) as L cos(theta) / pdf; these are the variances
// of that estimate divided by E^2, for three pdfs over solid angle. With k rays the relative
// standard error of their mean is sqrt(variance / k) (HDRI book, section 9.6).
struct RayVariance {
  double irradiance = 0;  // E, W/m^2; if it is 0, so are the variances
  double uniform = 0;     // pdf 1 / (2 pi) over the hemisphere: 2 pi x integral of L^2 cos^2 - E^2
  double cosine = 0;      // pdf cos / pi: pi x integral of L^2 cos - E^2
  double luminance = 0;   // pdf L / (integral of L) over the sphere, which also samples directions
                          // below the horizon: integral of L x integral of L cos^2 - E^2
};

// The variances for each of `normals` (unit). `latLong` is finite and not negative; radiance is
// constant over each texel. The integrals are as in exactIrradiance(), with rows of at most 1/256
// of the map. Parallel; the same bits for any number of threads.
std::vector<RayVariance> rayVariances(const Image& latLong, std::span<const vec3> normals);

// The number of rays for a relative standard error of `error`: variance / error^2, rounded up, at
// least 1.
double raysForError(double relativeVariance, double error);

}  // namespace chromeball
