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

// Glare of the human eye as a mixture of Gaussians.

// The point spread function of the eye adapted to daylight (Spencer, Shirley, Zimmerman and
// Greenberg, "Physically-Based Glare Effects for Digital Images", SIGGRAPH 1995), per steradian,
// `angle` in degrees:
//   0.384 f0 + 0.478 f1 + 0.138 f2,
//   f0 = 2.61e6 exp(-(angle / 0.02)^2), f1 = 20.91 / (angle + 0.02)^3, f2 = 72.37 / (angle +
//   0.02)^2,
// each of integral 1 over the hemisphere. Its flare lines (ciliary corona) are left out; the halo
// of the lens occurs only for the eye in the dark.
double spencerSpread(double angle);

// Gaussians that sum to it within 2% from 0.1 to 8 degrees, with weights that sum to 1; all pixels
// count as large as in the middle of the picture. The light of Gaussians narrower than a tenth of a
// pixel, and of the function beyond Gaussians of 30 degrees or kMaxSigma, stays in the pixel.
std::vector<WeightedGaussian> spencerGlare(double pixelsPerDegree);

}  // namespace chromeball
