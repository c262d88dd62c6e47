// SPDX-License-Identifier: Apache-2.0
#include "session/denoised_image.h"

#include <algorithm>

#include "base/progress.h"

namespace chromeball {

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

double addDenoised(Denoised denoised, double noise, OutputImage& image) {
  const double remaining = remainingNoise(denoised);
  Image& color = image.layers.front().image;
  Image noisy(color.width, color.height, 3);
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x) {
      noisy.setRgb(x, y, color.rgb(x, y));
      std::copy_n(denoised.color.at(x, y), denoised.color.channels, color.at(x, y));
    }
  image.layers.push_back({"noisy", "RGB", std::move(noisy)});
  image.layers.push_back({"denoise_error", "Y", std::move(denoised.error)});
  return noise < remaining ? noise : remaining;
}

std::optional<DenoiseReport> addDenoised(const Denoiser& denoise, double noise,
                                         const Progress& progress, OutputImage& image) {
  Stopwatch watch;
  std::optional<Denoised> found =
      denoise([&](double fraction) { progress(kRenderShare + (1 - kRenderShare) * fraction); });
  if (!found) return std::nullopt;
  const double remaining = addDenoised(*std::move(found), noise, image);
  return DenoiseReport{remaining, watch.lap()};
}

}  // namespace chromeball
