// SPDX-License-Identifier: Apache-2.0
// Glare of the human eye as a mixture of Gaussians.
#pragma once

#include "image/develop/bloom.h"

namespace chromeball {

// The point spread function of the eye adapted to daylight (Spencer, Shirley, Zimmerman and
// Greenberg, "Physically-Based Glare Effects for Digital Images", SIGGRAPH 1995), per steradian,
// `angle` in degrees:
//   0.384 f0 + 0.478 f1 + 0.138 f2,
//   f0 = 2.61e6 exp(-(angle / 0.02)^2), f1 = 20.91 / (angle + 0.02)^3, f2 = 72.37 / (angle +
//   0.02)^2,
// each of integral 1 over the hemisphere. Without its flare lines (ciliary corona); the halo of the
// lens is of the eye in the dark alone.
double spencerSpread(double angle);

// Gaussians that sum to it within 2% from 0.1 to 8 degrees, of weights that sum to 1, where all
// pixels are as large as in the middle of the picture. What is narrower than a tenth of a pixel,
// and what the function has beyond Gaussians of 30 degrees or kMaxSigma, stays in the pixel.
std::vector<WeightedGaussian> spencerGlare(double pixelsPerDegree);

}  // namespace chromeball
