// SPDX-License-Identifier: Apache-2.0
// Removes noise from a render, and estimates the error that remains: nonlinearly weighted
// first-order regression (Bitterli et al. 2016), of direct and indirect light apart.
#pragma once

#include <atomic>
#include <optional>

#include "base/progress.h"
#include "film/feature_film.h"

namespace chromeball {

// A render with Aov::Denoise; all images of one size, all numbers finite, albedo and normal
// below 1e6.
struct DenoiseInput {
  HalvedImage color, direct, albedo, normal, disparity;
};

struct Denoised {
  Image color;  // RGB radiance
  Image error;  // one channel: estimated standard error of luminance, noise and blur together
};

// Biased: details that noise hides are lost. Where the estimated error of the filter exceeds the
// noise, the image stays as it is. The result does not depend on the number of threads.
// nullopt if `stop` is set meanwhile.
std::optional<Denoised> denoise(const DenoiseInput& input, const Progress& progress,
                                const std::atomic<bool>& stop);

// The root mean square of the pixels' estimated relative errors, as Noise::noise; NaN for a
// black image.
double remainingNoise(const Denoised& denoised);

// Peak memory of denoise().
double denoiseBytes(int width, int height);

}  // namespace chromeball
