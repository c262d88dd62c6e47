// SPDX-License-Identifier: Apache-2.0
#include "image/develop/develop.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "image/develop/bloom.h"

namespace chromeball {
namespace {

size_t clearInvalid(Image& image) {
  size_t count = 0;
  for (size_t i = 0; i < image.pixels(); ++i) {
    const std::span<float> pixel(image.at(i), size_t(image.channels));
    if (std::ranges::all_of(pixel, [](float x) { return std::isfinite(x); })) continue;
    std::ranges::fill(pixel, 0.0f);
    ++count;
  }
  return count;
}

void clipColor(Image& image, float maximum) {
  for (size_t i = 0; i < image.pixels(); ++i)
    for (int c = 0; c < 3; ++c) image.at(i)[c] = std::min(image.at(i)[c], maximum);
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
