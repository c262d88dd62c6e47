// SPDX-License-Identifier: Apache-2.0
// Removes noise from a render, and estimates the error that remains: nonlinearly weighted
// first-order regression (Bitterli et al. 2016).
#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "film/layer_film.h"

namespace chromeball {

// All images are of one size, all numbers finite, albedo and normal below 1e6.
struct DenoiseInput {
  // RGB: light that is filtered apart, as direct and indirect light. Values may be negative.
  std::vector<HalvedImage> parts;
  HalvedImage albedo, normal, disparity;  // of FeatureFilm
};

// Both images are RGB; the errors are estimates of noise and blur together.
struct DenoisedPart {
  Image color, standardError;
};

// Biased: details that noise hides are lost. Where the estimated error of the filter exceeds the
// noise, the part stays as it is; so do pixels that are black and whose neighbours are. The result
// does not depend on the number of threads. nullopt if `stop` is set meanwhile.
std::optional<std::vector<DenoisedPart>> denoise(const DenoiseInput& input,
                                                 const Progress& progress,
                                                 const std::atomic<bool>& stop);

struct Denoised {
  Image color;       // RGB radiance; RGBA of a shadow catcher
  Image error;       // one channel: estimated standard error of luminance
  Image whole = {};  // errors are relative to it; empty: the colour
};

// The sum of the parts; negative radiance is set to 0.
Denoised sumOf(const std::vector<DenoisedPart>& parts);

// The estimated relative errors, as relativeErrors() of film/noise.h; NaN for a black image.
Image relativeErrors(const Denoised& denoised);
double remainingNoise(const Image& relativeErrors);  // their root mean square, as Noise::noise

// Peak memory of denoise().
double denoiseBytes(int width, int height, int parts);

}  // namespace chromeball
