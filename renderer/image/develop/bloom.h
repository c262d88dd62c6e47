// SPDX-License-Identifier: Apache-2.0
// Bloom: an image blurred by a mixture of Gaussians, so that bright regions spread over their
// surroundings as in a lens or an eye (HDRI book, section 9.2.5; "Rendering with Natural Light").
#pragma once

#include <vector>

#include "image/develop/gaussian_line.h"
#include "image/image.h"

namespace chromeball {

struct WeightedGaussian {
  double weight;
  double sigma;  // pixels
};

inline constexpr double kMaxSigma = 4096;

// Blurs all channels by the separable Gaussian of gaussian_line.h, in place. Infinity and NaN
// spread.
void blurGaussian(Image& image, double sigma, GaussianMethod method);

// The sum of weight x Gaussian(sigma) * image. Keeps the sum of the pixels if the weights sum to 1.
// Needs the memory of two more images.
Image bloom(const Image& image, const std::vector<WeightedGaussian>& mixture,
            GaussianMethod method);

}  // namespace chromeball
