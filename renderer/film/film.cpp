// SPDX-License-Identifier: Apache-2.0
#include "film/film.h"

#include <algorithm>
#include <limits>

namespace chromeball {

Film::Film(int width, int height)
    : width_(width), height_(height), pixels_(size_t(width) * size_t(height)) {}

glm::dvec3 Film::Pixel::mean() const { return (sums[0] + sums[1]) / double(std::max(count(), 1u)); }

void Film::add(int x, int y, int half, const SampleSums& samples) {
  Pixel& p = pixels_[size_t(y) * size_t(width_) + size_t(x)];
  p.counts[size_t(half)] += samples.count;
  p.sums[size_t(half)] += samples.sum;
  p.sumOfSquares += samples.sumOfSquares;
}

Image Film::mean() const {
  Image image(width_, height_, 3);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x)
      image.setRgb(x, y, Rgb(pixels_[size_t(y) * size_t(width_) + size_t(x)].mean()));
  return image;
}

Image Film::sampleCounts() const {
  Image image(width_, height_, 1);
  for (size_t i = 0; i < pixels_.size(); ++i) image.texels[i] = float(pixels_[i].count());
  return image;
}

PixelErrors Film::errors() const {
  const glm::dvec4 unknown(std::numeric_limits<double>::quiet_NaN());
  PixelErrors errors{width_, height_, {}, {}, {}};
  errors.luminances.reserve(pixels_.size());
  errors.halves.assign(pixels_.size(), unknown);
  errors.scatter.assign(pixels_.size(), unknown);
  for (size_t i = 0; i < pixels_.size(); ++i) {
    const Pixel& p = pixels_[i];
    errors.luminances.push_back(luminance(p.mean()));
    if (p.counts[0] == 0 || p.counts[1] == 0) continue;
    const double n0 = p.counts[0], n1 = p.counts[1], n = n0 + n1;
    const glm::dvec3 sum = p.sums[0] + p.sums[1];
    const glm::dvec3 difference = p.sums[0] / n0 - p.sums[1] / n1;
    const glm::dvec4 mean(sum / n, luminance(sum / n));
    const glm::dvec4 differences(difference, luminance(difference));
    // Var(mean of all n samples) = n0 n1 / n^2 Var(difference of the means of the halves).
    errors.halves[i] = differences * differences * (n0 * n1 / (n * n));
    errors.scatter[i] = glm::max(p.sumOfSquares / n - mean * mean, 0.0) / (n - 1);
  }
  return errors;
}

}  // namespace chromeball
