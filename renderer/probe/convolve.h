// SPDX-License-Identifier: Apache-2.0
// Prefiltered environment maps: a probe blurred by a kernel (HDRI book, section 9.8.1).
#pragma once

#include <span>
#include <vector>

#include "image/image.h"
#include "probe/mapping.h"
#include "probe/zonal_kernel.h"

namespace chromeball {

// The mean of radiance under the kernel around each of the `directions` (unit). `latLong` is finite
// and constant over each texel, of any size. Rectangles over which the kernel varies little are
// taken whole, with their first moments: the kernel is off by at most `error` of the geometric mean
// of its value and its peak, the result by about `error` of itself and of the map's mean
// (tests/convolve_test.cpp). Time is in proportion to 1 / error. A constant map keeps its value to
// 1e-6 (under a cosine to 6e-5: exactIrradiance()). Parallel; the same bits for any number of
// threads.
std::vector<dvec3> convolve(const Image& latLong, const ZonalKernel& kernel,
                            std::span<const vec3> directions, double error = 1e-3);

// The same from nine spherical harmonics (Ramamoorthi and Hanrahan 2001): blurred more than by the
// kernel where that is narrow, and perhaps negative.
std::vector<dvec3> shConvolve(const Image& latLong, const ZonalKernel& kernel,
                              std::span<const vec3> directions);

}  // namespace chromeball
