// SPDX-License-Identifier: Apache-2.0
// The layers of a denoised image.
#pragma once

#include <functional>

#include "base/progress.h"
#include "denoise/denoise.h"
#include "film/noise.h"
#include "image/io/write_image.h"
#include "render/render.h"

namespace chromeball {

// The error that a denoised image has left.
struct DenoiseReport {
  double noise = 0;  // as Noise::noise, estimated
  double seconds = 0;
};

// The parts of an image that are filtered apart.
std::vector<HalvedImage> directAndIndirect(const HalvedImage& color, const HalvedImage& direct);

// `result` must have been rendered with `denoise`. nullopt if `stop` is set meanwhile.
std::optional<Denoised> denoiseRender(const RenderResult& result, const Progress& progress,
                                      const std::atomic<bool>& stop);

// The share of rendering in the progress of a render that denoises.
inline constexpr double kRenderShare = 0.9;

// Replaces the color of `image` by the denoised one (alpha only if it is denoised too), and adds
// the layers `noisy` and `denoise_error`. `progress` receives fractions from kRenderShare to 1.
// `noise`: the noise before denoising, which the remaining noise does not exceed; NaN: unknown.
// nullopt if `denoise` returns nullopt.
using Denoiser = std::function<std::optional<Denoised>(const Progress& progress)>;
std::optional<DenoiseReport> addDenoised(const Denoiser& denoise, double noise,
                                         const Progress& progress, OutputImage& image);

// The same with an image that is already denoised. Returns the remaining noise.
double addDenoised(Denoised denoised, double noise, OutputImage& image);

// The noise of an image.

struct ImageNoise {
  double noise, median, p95;  // fractions (film/noise.h)
  Image variance;             // of each pixel's mean, RGB

  explicit ImageNoise(const PixelErrors& errors) {
    const std::vector<glm::dvec4> squared = squaredStandardErrors(errors);
    const NoiseQuantiles quantiles = noiseQuantiles(errors, squared);
    noise = estimateNoise(errors).noise;
    median = quantiles.median, p95 = quantiles.p95;
    variance = varianceImage(squared, errors.width, errors.height);
  }
};

}  // namespace chromeball
