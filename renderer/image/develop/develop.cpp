// SPDX-License-Identifier: Apache-2.0
#include "image/develop/develop.h"

#include <algorithm>
#include <cmath>

#include "image/develop/bloom.h"
#include "image/develop/vignette.h"

namespace chromeball {
namespace {

size_t clearInvalid(Image& image) {
  const size_t channels = size_t(image.channels);
  size_t count = 0;
  for (size_t i = 0; i < image.texels.size(); i += channels) {
    const auto pixel = image.texels.begin() + ptrdiff_t(i);
    if (std::all_of(pixel, pixel + ptrdiff_t(channels), [](float x) { return std::isfinite(x); }))
      continue;
    std::fill_n(pixel, channels, 0.0f);
    ++count;
  }
  return count;
}

void clipColor(Image& image, float maximum) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      float* pixel = image.at(x, y);
      for (int c = 0; c < 3; ++c) pixel[c] = std::min(pixel[c], maximum);
    }
}

size_t countLimited(const Image& depth, const ThinLens& lens, const ViewFrame& frame) {
  return size_t(std::ranges::count_if(depth.texels, [&](float z) {
    return confusionRadius(lens, double(z), frame) >= kMaxConfusionRadius;
  }));
}

}  // namespace

DevelopReport develop(Image& image, const DevelopSettings& settings, const Image* depth,
                      const ViewFrame& frame) {
  DevelopReport report;
  if (settings.clip) clipColor(image, *settings.clip);  // infinity too
  report.invalid = clearInvalid(image);
  if (settings.lens) {
    report.limited = countLimited(*depth, *settings.lens, frame);
    image = blurByDepth(image, *depth, *settings.lens, frame);
  }
  if (settings.motion) image = blurMotion(image, *settings.motion);
  if (!settings.bloom.empty()) image = bloom(image, settings.bloom, settings.method);
  if (settings.glare) image = bloom(image, spencerGlare(frame.pixelsPerDegree()), settings.method);
  if (settings.falloff)
    multiplyFalloff(image, *settings.falloff, frame);
  else if (settings.vignette > 0)
    vignette(image, settings.vignette, frame);
  return report;
}

}  // namespace chromeball
