// SPDX-License-Identifier: Apache-2.0
// Removes noise from a render, and estimates the error that remains: nonlinearly weighted
// first-order regression (Bitterli et al. 2016), of direct and indirect light apart.
#pragma once

#include "base/progress.h"
#include "film/feature_film.h"

namespace chromeball {

// A render with Aov::Denoise; all images of one size, all numbers finite.
struct DenoiseInput {
  HalvedImage color, direct, albedo, normal, disparity;
};

struct Denoised {
  Image color;  // RGB radiance
  Image error;  // one channel: estimated standard error of luminance, noise and blur together
};

// Biased: details that noise hides are lost. Where the estimated error of the filter exceeds the
// noise, the image stays as it is. The result does not depend on the number of threads.
Denoised denoise(const DenoiseInput& input, const Progress& progress);

// The root mean square of the pixels' estimated relative errors, as Noise::noise.
double remainingNoise(const Denoised& denoised);

// Peak memory of denoise().
inline constexpr size_t kDenoiseBytesPerPixel = 600;

}  // namespace chromeball
