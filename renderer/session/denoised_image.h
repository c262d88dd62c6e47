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

// The noise of an image, and what a denoised one has left of it: fractions, NaN if unknown.
struct NoiseFigures {
  double noise, median, p95;  // as Noise and NoiseQuantiles (film/noise.h)
};

struct DenoiseReport : NoiseFigures {
  Image relative;  // estimated relative error of each pixel
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
// `before`: the noise before denoising, which no figure of the remaining noise exceeds. nullopt if
// `denoise` returns nullopt.
using Denoiser = std::function<std::optional<Denoised>(const Progress& progress)>;
std::optional<DenoiseReport> addDenoised(const Denoiser& denoise, const NoiseFigures& before,
                                         const Progress& progress, OutputImage& image);

// The same with an image that is already denoised.
DenoiseReport addDenoised(Denoised denoised, const NoiseFigures& before, OutputImage& image);

struct ImageNoise : NoiseFigures {
  Image variance;  // of each pixel's mean, RGB
  Image relative;  // relative error of each pixel (film/noise.h)

  explicit ImageNoise(const PixelErrors& errors);
};

}  // namespace chromeball
