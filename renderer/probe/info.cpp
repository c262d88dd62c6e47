// SPDX-License-Identifier: Apache-2.0
#include "probe/info.h"

#include <array>
#include <bit>
#include <limits>
#include <numeric>
#include <tuple>

#include "base/memory.h"

namespace chromeball {
Plateau plateau(const Image& latLong) {
  constexpr size_t kMinTexels = 8;
  constexpr double kMinSolidAngle = 1.36e-4, kMaxSolidAngle = 0.9 * 4 * kPiD;
  float maximum = 0;
  forTexels(latLong,
            [&](int, int, const Rgb& c, double) { maximum = std::max(maximum, maxComponent(c)); });
  Plateau found;
  size_t shoulder = 0;
  forTexels(latLong, [&](int, int, const Rgb& c, double solidAngle) {
    if (maxComponent(c) >= 0.998f * maximum) {
      ++found.texels;
      found.solidAngle += solidAngle;
    } else if (maxComponent(c) >= 0.99f * maximum) {
      ++shoulder;
    }
  });
  found.looksClipped = maximum > 0 && found.texels >= kMinTexels && shoulder < found.texels &&
                       found.solidAngle >= kMinSolidAngle && found.solidAngle <= kMaxSolidAngle;
  return found;
}

double robustRange(const Image& latLong) {
  constexpr double kTail = 0.01;
  // A histogram by the upper half of a float's bits: 128 bins for each factor of two.
  std::array<double, 0x8000> solidAngles{};
  forTexels(latLong, [&](int, int, const Rgb& c, double solidAngle) {
    solidAngles[std::bit_cast<uint32_t>(std::max(luminance(c), 0.0f)) >> 16] += solidAngle;
  });
  const auto percentile = [&](double fraction) {
    double below = 0;
    size_t bin = 0;
    while (bin + 1 < solidAngles.size() && (below += solidAngles[bin]) <= fraction * 4 * kPiD)
      ++bin;
    return double(std::bit_cast<float>(uint32_t(bin) << 16));
  };
  const double low = percentile(kTail), high = percentile(1 - kTail);
  if (high == 0) return 0;
  return low > 0 ? high / low : std::numeric_limits<double>::infinity();
}

double lostIfClippedAtWhite(const Image& latLong) {
  constexpr double kMean = 0.18;
  const double mean = luminance(meanRadiance(latLong)), white = mean / kMean;
  double all = 0, lost = 0;
  forTexels(latLong, [&](int, int, const Rgb& c, double solidAngle) {
    const glm::dvec3 radiance(c);
    all += solidAngle * (radiance.x + radiance.y + radiance.z);
    for (int i = 0; i < 3; ++i) lost += solidAngle * std::max(radiance[i] - white, 0.0);
  });
  return all > 0 ? lost / all : 0;
}

namespace {

std::vector<BrightestTexels> brightestTexels(const Image& image) {
  const size_t width = size_t(image.width), count = width * size_t(image.height);
  // With large maps memory access takes most of the time: only what the order needs is kept.
  std::vector<float> brightness = longArray<float>(count);
  std::vector<double> solidAngles;
  double total = 0;
  for (int y = 0; y < image.height; ++y) {
    solidAngles.push_back(texelSolidAngle(y, image.width, image.height));
    for (int x = 0; x < image.width; ++x) {
      const float l = luminance(image.rgb(x, y));
      brightness[size_t(y) * width + size_t(x)] = l;
      total += l * solidAngles.back();
    }
  }
  const auto flux = [&](uint32_t i) { return brightness[i] * solidAngles[i / width]; };
  // A total order, so that each set contains the smaller ones: ties go to the texel with more flux.
  std::vector<uint32_t> order = longArray<uint32_t>(count);
  std::iota(order.begin(), order.end(), 0u);
  const auto isBrighter = [&](uint32_t a, uint32_t b) {
    if (brightness[a] != brightness[b]) return brightness[a] > brightness[b];
    return std::tuple(flux(b), a) < std::tuple(flux(a), b);
  };

  const size_t percent = std::max<size_t>(1, count / 100);
  std::vector<BrightestTexels> sets;
  std::vector<size_t> counts{1, 10, 100, percent};
  std::sort(counts.begin(), counts.end());
  counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
  for (const size_t brightest : counts) {
    if (brightest > count) continue;
    std::nth_element(order.begin(), order.begin() + (brightest - 1), order.end(), isBrighter);
    double sum = 0;
    for (size_t i = 0; i < brightest; ++i) sum += flux(order[i]);
    sets.push_back({brightest, total > 0 ? sum / total : 0});
  }
  return sets;
}

}  // namespace

ProbeInfo probeInfo(const Image& image) {
  ProbeInfo info;
  info.min = Rgb(std::numeric_limits<float>::max());
  float darkest = std::numeric_limits<float>::max(), brightest = -1;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgb c = image.rgb(x, y);
      const float l = luminance(c);
      info.min = glm::min(info.min, c);
      info.max = glm::max(info.max, c);
      info.mean += dvec3(c);
      if (l > 0) darkest = std::min(darkest, l);
      if (l > brightest) {
        brightest = l;
        info.brightest = c;
        info.brightestDirection = texelDirection({image.width, image.height}, x, y);
      }
    }
  info.mean /= double(image.width) * image.height;
  info.meanRadiance = meanRadiance(image);
  info.dynamicRange = brightest > 0 ? double(brightest) / darkest : 0;
  const double mean = luminance(info.meanRadiance);
  info.maxOverMean = mean > 0 ? double(brightest) / mean : 0;
  info.robustRange = robustRange(image);
  info.plateau = plateau(image);
  info.lostIfClippedAtWhite = lostIfClippedAtWhite(image);
  info.suns = extractSuns(image).suns;
  info.brightestTexels = brightestTexels(image);
  return info;
}

}  // namespace chromeball
