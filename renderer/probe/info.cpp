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

dvec3 centreDirection(const Image& image, int x, int y) {
  return *uvToDirection(Mapping::LatLong, {(x + 0.5) / image.width, (y + 0.5) / image.height});
}

double fluxOf(const Image& image, int x, int y) {
  return luminance(image.rgb(x, y)) * texelSolidAngle(y, image.width, image.height);
}

std::vector<BrightestShare> brightestShares(const Image& image) {
  const size_t count = size_t(image.width) * image.height;
  std::vector<double> flux(count);
  std::vector<float> brightness(count);
  for (size_t i = 0; i < count; ++i) {
    const int x = int(i % image.width), y = int(i / image.width);
    flux[i] = fluxOf(image, x, y);
    brightness[i] = luminance(image.rgb(x, y));
  }
  // Of equally bright texels the one with the most flux first: each set holds those before it.
  std::vector<size_t> order(count);
  std::iota(order.begin(), order.end(), size_t(0));
  const auto isBrighter = [&](size_t a, size_t b) {
    return std::tuple(brightness[b], flux[b], a) < std::tuple(brightness[a], flux[a], b);
  };
  const double total = std::accumulate(flux.begin(), flux.end(), 0.0);

  const size_t percent = std::max<size_t>(1, count / 100);
  std::vector<BrightestShare> shares;
  std::vector<size_t> counts{1, 10, 100, percent};
  std::sort(counts.begin(), counts.end());
  counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
  for (const size_t brightest : counts) {
    if (brightest > count) continue;
    std::nth_element(order.begin(), order.begin() + (brightest - 1), order.end(), isBrighter);
    double sum = 0;
    for (size_t i = 0; i < brightest; ++i) sum += flux[order[i]];
    shares.push_back({brightest, total > 0 ? sum / total : 0});
  }
  return shares;
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
        info.brightestDirection = centreDirection(image, x, y);
      }
    }
  info.mean /= double(image.width) * image.height;
  info.meanRadiance = meanRadiance(image);
  info.dynamicRange = brightest > 0 ? double(brightest) / darkest : 0;
  info.suns = extractSuns(image).suns;
  info.brightestShares = brightestShares(image);
  return info;
}

}  // namespace chromeball
