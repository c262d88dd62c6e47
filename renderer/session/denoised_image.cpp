// SPDX-License-Identifier: Apache-2.0
#include "session/denoised_image.h"

#include <algorithm>

#include "base/progress.h"

namespace chromeball {
namespace {

NoiseFigures remaining(const Image& relative, const NoiseFigures& before) {
  const NoiseQuantiles quantiles = noiseQuantiles(relative);
  const auto limited = [](double after, double was) { return was < after ? was : after; };
  return {limited(remainingNoise(relative), before.noise), limited(quantiles.median, before.median),
          limited(quantiles.p95, before.p95)};
}

}  // namespace

std::vector<HalvedImage> directAndIndirect(const HalvedImage& color, const HalvedImage& direct) {
  return {direct, color - direct};
}

std::optional<Denoised> denoiseRender(const RenderResult& result, const Progress& progress,
                                      const std::atomic<bool>& stop) {
  const FeatureFilm& features = result.features;
  const HalvedImage color{result.film.mean(), result.film.halfDifference()};
  const auto parts = denoise({directAndIndirect(color, features.direct()), features.albedo(),
                              features.normal(), features.disparity()},
                             progress, stop);
  if (!parts) return std::nullopt;
  return sumOf(*parts);
}

DenoiseReport addDenoised(Denoised denoised, const NoiseFigures& before, OutputImage& image) {
  DenoiseReport report;
  report.relative = relativeErrors(denoised);
  static_cast<NoiseFigures&>(report) = remaining(report.relative, before);
  Image& color = image.layers.front().image;
  Image noisy(color.width, color.height, 3);
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x) {
      noisy.setRgb(x, y, color.rgb(x, y));
      std::copy_n(denoised.color.at(x, y), denoised.color.channels, color.at(x, y));
    }
  image.layers.push_back({"noisy", "RGB", std::move(noisy)});
  image.layers.push_back({"denoise_error", "Y", std::move(denoised.error)});
  return report;
}

std::optional<DenoiseReport> addDenoised(const Denoiser& denoise, const NoiseFigures& before,
                                         const Progress& progress, OutputImage& image) {
  Stopwatch watch;
  std::optional<Denoised> found =
      denoise([&](double fraction) { progress(kRenderShare + (1 - kRenderShare) * fraction); });
  if (!found) return std::nullopt;
  DenoiseReport report = addDenoised(*std::move(found), before, image);
  report.seconds = watch.lap();
  return report;
}

ImageNoise::ImageNoise(const PixelErrors& errors) {
  const std::vector<glm::dvec4> squared = squaredStandardErrors(errors);
  variance = varianceImage(squared, errors.width, errors.height);
  relative = relativeErrors(errors, squared);
  const NoiseQuantiles quantiles = noiseQuantiles(relative);
  noise = estimateNoise(errors).noise;
  median = quantiles.median, p95 = quantiles.p95;
}

}  // namespace chromeball
