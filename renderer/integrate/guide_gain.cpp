// SPDX-License-Identifier: Apache-2.0
#include "integrate/guide_gain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace chromeball {
namespace {

constexpr std::array kFractions = {0.0f, 0.1f, 0.25f, 0.5f};
// Time of a path relative to that without a guide: more bounces meet glass and metal.
constexpr std::array kTimes = {1.0, 1.2, 1.3, 1.5};
constexpr double kDark = 0.01;  // as in the estimate of noise

template <class Visit>
void forErrors(size_t tile, const TileGrid& tiles, const PixelErrors& errors, const Visit& visit) {
  tiles.forPixels(tile, [&](int x, int y) {
    const size_t pixel = size_t(y) * size_t(tiles.width) + size_t(x);
    if (std::isfinite(errors.scatter[pixel].w))
      visit(errors.luminances[pixel], errors.scatter[pixel].w);
  });
}

double meanLuminance(size_t tile, const TileGrid& tiles, const PixelErrors& errors) {
  double sum = 0;
  size_t count = 0;
  forErrors(tile, tiles, errors, [&](double luminance, double) { sum += luminance, ++count; });
  return count > 0 ? sum / double(count) : 0;
}

}  // namespace

// The part of recorded light in a pixel's variance is E[x^2] / samples, which another fraction
// changes by the ratio of the pdfs. Variances count relative to the luminance of the tile.
float bestFraction(std::span<const GuideRecords> records, double fractionOfPixels,
                   const TileGrid& tiles, const PixelErrors& errors, uint32_t samples,
                   bool always) {
  const double recordedSamples = samples * fractionOfPixels;
  std::vector<double> luminances(records.size());
  double mean = 0;
  for (size_t tile = 0; tile < records.size(); ++tile) {
    luminances[tile] = meanLuminance(tile, tiles, errors);
    mean += luminances[tile] / double(records.size());
  }
  double now = 0, recorded = 0;
  std::array<double, kFractions.size()> moments{};
  for (size_t tile = 0; tile < records.size(); ++tile) {
    const double luminance = std::max(luminances[tile], kDark * mean);
    if (!(luminance > 0)) continue;
    forErrors(tile, tiles, errors, [&](double ofPixel, double squared) {
      const double larger = std::max(ofPixel, luminance);  // highlights
      now += squared / (larger * larger);
    });
    const double scale = 1 / (luminance * luminance * samples * recordedSamples);
    double sum = 0, count = 0;
    tiles.forPixels(tile, [&](int, int) { count += recordedSamples; });
    for (const BounceRecord& r : records[tile].bounces) sum += double(r.found);
    const double squaredMean = scale * sum * sum / count;
    recorded -= squaredMean;
    for (double& moment : moments) moment -= squaredMean;
    for (const BounceRecord& r : records[tile].bounces) {
      const auto pdf = [&](float fraction) {
        return double(fraction) * double(r.lobesPdf) + (1 - double(fraction)) * double(r.bsdfPdf);
      };
      const double squared = scale * double(r.found) * double(r.found);
      recorded += squared;
      for (size_t k = 0; k < kFractions.size(); ++k)
        if (const double other = pdf(kFractions[k]); other > 0)
          moments[k] += squared * pdf(r.fraction) / other;
    }
  }
  const double rest = std::max(now - recorded, 0.0);
  const auto cost = [&](size_t k) { return (rest + moments[k]) * kTimes[k]; };
  size_t best = always ? 1 : 0;
  for (size_t k = best; k < kFractions.size(); ++k)
    if (cost(k) < cost(best)) best = k;
  return kFractions[best];
}

}  // namespace chromeball
