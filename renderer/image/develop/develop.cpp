// SPDX-License-Identifier: Apache-2.0
#include "image/develop/develop.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/parallel.h"
#include "image/develop/bloom.h"

namespace chromeball {
namespace {

struct Tap {
  int dx, dy;
  double weight;
};

void normalize(std::vector<Tap>& taps) {
  constexpr double kNegligible = 1e-9;  // weight of a second pixel due to rounding
  std::erase_if(taps, [](const Tap& tap) { return tap.weight < kNegligible; });
  double sum = 0;
  for (const Tap& tap : taps) sum += tap.weight;
  for (Tap& tap : taps) tap.weight /= sum;
}

std::vector<Tap> tapsOf(const Motion& motion) {
  const double angle = double(kPiD) / 180 * std::fmod(motion.angle, 360);
  const double x = std::cos(angle), y = -std::sin(angle);  // rows run downwards
  const bool isFlat = std::fabs(x) >= std::fabs(y);
  const double slope = isFlat ? y / x : x / y;
  const double half = motion.length / 2 * std::max(std::fabs(x), std::fabs(y));
  std::vector<Tap> taps;
  const int reach = int(std::ceil(half + 0.5));
  for (int step = -reach; step <= reach; ++step) {
    const double begin = std::max(-half, step - 0.5), end = std::min(half, step + 0.5);
    if (end <= begin) continue;
    const double aside = slope * (begin + end) / 2, floor = std::floor(aside), t = aside - floor;
    for (const auto& [offset, share] : {std::pair(int(floor), 1 - t), {int(floor) + 1, t}})
      taps.push_back({isFlat ? step : offset, isFlat ? offset : step, share * (end - begin)});
  }
  normalize(taps);
  return taps;
}

// sum += weight x (the row, from `dx` on).
void addShifted(const Image& image, int y, const Tap& tap, std::vector<double>& sum) {
  const int channels = image.channels, width = image.width;
  const float* row = image.at(0, y);
  const int begin = std::clamp(-tap.dx, 0, width), end = std::clamp(width - tap.dx, begin, width);
  const auto addMirrored = [&](int x) {
    const float* from = row + size_t(mirrored(int64_t(x) + tap.dx, width)) * size_t(channels);
    for (int c = 0; c < channels; ++c)
      sum[size_t(x * channels + c)] += tap.weight * double(from[c]);
  };
  for (int x = 0; x < begin; ++x) addMirrored(x);
  const int64_t shift = int64_t(tap.dx) * channels;
  for (int i = begin * channels; i < end * channels; ++i)
    sum[size_t(i)] += tap.weight * double(row[i + shift]);
  for (int x = end; x < width; ++x) addMirrored(x);
}

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

Image blurMotion(const Image& image, const Motion& motion) {
  if (image.empty() || !(motion.length > 0)) return image;
  const std::vector<Tap> taps = tapsOf(motion);
  Image blurred(image.width, image.height, image.channels);
  const size_t across = size_t(image.width) * size_t(image.channels);
  forRanges(size_t(image.height), taps.size() * across, [&](size_t begin, size_t end) {
    std::vector<double> sum(across);
    for (size_t y = begin; y < end; ++y) {
      std::ranges::fill(sum, 0.0);
      for (const Tap& tap : taps)
        addShifted(image, mirrored(int64_t(y) + tap.dy, image.height), tap, sum);
      for (size_t i = 0; i < across; ++i) blurred.at(0, int(y))[i] = float(sum[i]);
    }
  });
  return blurred;
}

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
