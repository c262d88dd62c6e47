// SPDX-License-Identifier: Apache-2.0
// Photographs that a perfect camera takes of known radiance.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "probe/capture/exposure.h"

namespace chromeball {

// The level, 0 to 1, of an exposure.
using Encoding = std::function<double(double)>;

double encodeSrgb(double exposure);
inline double encodeLinear(double exposure) { return exposure; }

// The level, clipped at white and rounded to a multiple of 1 / steps (255: 8 bits; 0: not rounded).
Image photographed(const Image& radiance, const dvec3& factor, const Encoding& encode = encodeSrgb,
                   int steps = 255);

std::vector<Exposure> bracket(const Image& radiance, const std::vector<double>& factors,
                              const Encoding& encode = encodeSrgb, int steps = 255);

// An image of radiance from `low` to `high`, evenly distributed by its logarithm, in another order
// in each channel: along columns in red, and in small waves that cover the image.
Image ramp(int width, int height, double low, double high);

}  // namespace chromeball
