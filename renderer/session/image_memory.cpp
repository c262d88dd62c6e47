// SPDX-License-Identifier: Apache-2.0
#include "session/image_memory.h"

#include <algorithm>
#include <cstring>

#include "denoise/denoise.h"

namespace chromeball {
namespace {

// Of a pixel, bytes.
struct PixelMemory {
  double film = double(Film::bytesPerPixel());  // all sums of samples
  double texels = 4 * sizeof(float);            // of the output: the colour and the layers
};

PixelMemory pixelMemory(const RenderSettings& settings) {
  PixelMemory m;
  if (!settings.aovs.empty()) m.film += 2 * sizeof(uint32_t);
  if (settings.wantsFeatures()) m.film += double(FeatureFilm::bytesPerPixel());
  for (Aov aov : settings.aovs) {
    const double channels = aov == Aov::Denoise
                                ? FeatureFilm::kLayerChannels
                                : std::max<double>(1, double(std::strlen(aovInfo(aov).channels)));
    if (aov != Aov::Denoise) m.film += channels * sizeof(double);  // made of the features
    m.texels += channels * sizeof(float);
  }
  return m;
}

double pixelsOf(const RenderSettings& settings) {
  return double(settings.window().width) * settings.window().height;
}

}  // namespace

double imageBytes(const RenderSettings& settings) {
  const PixelMemory pixel = pixelMemory(settings);
  // Estimating the noise takes three fields of errors, two of luminances and the variance; later
  // the layers and the texels of the file exist together.
  constexpr double kNoise = 3 * sizeof(glm::dvec4) + 2 * sizeof(double) + 3 * sizeof(float);
  constexpr int kMaxParts = 3;  // of denoise(): of composites
  const Crop window = settings.window();
  const double denoising =
      settings.denoise ? denoiseBytes(window.width, window.height, kMaxParts) : 0;
  return pixelsOf(settings) * (pixel.film + std::max(kNoise, 2 * pixel.texels)) + denoising;
}

double snapshotBytes(const RenderSettings& settings) {
  const PixelMemory pixel = pixelMemory(settings);
  return pixelsOf(settings) * (pixel.film + 2 * pixel.texels);
}

}  // namespace chromeball
