// SPDX-License-Identifier: Apache-2.0
#include "probe/info.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "probe/solid_angle.h"
#include "probe/sun_extraction.h"

namespace chromeball {
namespace {

double fluxOf(const Image& image, int x, int y) {
  return luminance(image.rgb(x, y)) * texelSolidAngle(y, image.width, image.height);
}

std::vector<BrightestTexels> brightestTexels(const Image& image) {
  const size_t count = size_t(image.width) * image.height;
  std::vector<double> flux(count);
  std::vector<float> brightness(count);
  for (size_t i = 0; i < count; ++i) {
    const int x = int(i % image.width), y = int(i / image.width);
    flux[i] = fluxOf(image, x, y);
    brightness[i] = luminance(image.rgb(x, y));
  }
  // A total order, so that each set contains the smaller ones: ties go to the texel with more flux.
  std::vector<size_t> order(count);
  std::iota(order.begin(), order.end(), size_t(0));
  const auto isBrighter = [&](size_t a, size_t b) {
    return std::tuple(brightness[b], flux[b], a) < std::tuple(brightness[a], flux[a], b);
  };
  const double total = std::accumulate(flux.begin(), flux.end(), 0.0);

  const size_t percent = std::max<size_t>(1, count / 100);
  std::vector<BrightestTexels> sets;
  std::vector<size_t> counts{1, 10, 100, percent};
  std::sort(counts.begin(), counts.end());
  counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
  for (const size_t brightest : counts) {
    if (brightest > count) continue;
    std::nth_element(order.begin(), order.begin() + (brightest - 1), order.end(), isBrighter);
    double sum = 0;
    for (size_t i = 0; i < brightest; ++i) sum += flux[order[i]];
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
