// SPDX-License-Identifier: Apache-2.0
#include "session/image_memory.h"

#include <algorithm>
#include <cstring>

#include "denoise/denoise.h"

namespace chromeball {

double imageBytes(const RenderSettings& settings) {
  const Crop window = settings.window();
  double sums = settings.aovs.empty() ? 0 : 2 * sizeof(uint32_t), texels = 4 * sizeof(float);
  if (settings.wantsFeatures()) sums += double(FeatureFilm::bytesPerPixel());
  for (Aov aov : settings.aovs) {
    const double channels = aov == Aov::Denoise
                                ? FeatureFilm::kLayerChannels
                                : std::max<double>(1, double(std::strlen(aovInfo(aov).channels)));
    if (aov != Aov::Denoise) sums += channels * sizeof(double);  // made of the features
    texels += channels * sizeof(float);
  }
  // Estimating the noise takes three fields of errors, two of luminances and the variance; later
  // the layers and the texels of the file exist together.
  constexpr double kNoise = 3 * sizeof(glm::dvec4) + 2 * sizeof(double) + 3 * sizeof(float);
  const double maximum = std::max(kNoise, 2 * texels);
  constexpr int kMaxParts = 3;  // of denoise(): of composites
  const double denoising =
      settings.denoise ? denoiseBytes(window.width, window.height, kMaxParts) : 0;
  return double(window.width) * window.height * (double(Film::bytesPerPixel()) + sums + maximum) +
         denoising;
}

}  // namespace chromeball
