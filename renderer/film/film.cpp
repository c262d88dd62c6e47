// SPDX-License-Identifier: Apache-2.0
#include "film/film.h"

#include <cassert>
#include <limits>

#include "base/memory.h"
#include "base/parallel.h"

namespace chromeball {
namespace {

// The sum of (x - mean)^2 with Bessel's correction; 0 where rounding errors may be all of it, so
// that equal samples have none.
glm::dvec4 squaredDeviations(const glm::dvec4& sumOfSquares, const glm::dvec3& sum, double count) {
  if (count < 2) return glm::dvec4(0);
  const glm::dvec4 mean(sum / count, luminance(sum / count));
  glm::dvec4 deviations = sumOfSquares - count * mean * mean;
  const glm::dvec4 rounding = count * std::numeric_limits<double>::epsilon() * sumOfSquares;
  for (int c = 0; c < 4; ++c)
    if (deviations[c] <= rounding[c]) deviations[c] = 0;
  return deviations * (count / (count - 1));
}

void subtract(Image& a, const Image& b) {
  for (size_t i = 0; i < a.texels.size(); ++i) a.texels[i] -= b.texels[i];
}

}  // namespace

Film::Film(int width, int height)
    : width_(width), height_(height), pixels_(longArray<Pixel>(size_t(width) * size_t(height))) {}

glm::dvec3 Film::Pixel::mean() const {
  return count() > 0 ? (sums[0] + sums[1]) / weight() : glm::dvec3(0);
}

void Film::add(int x, int y, int half, const SampleSums& samples) {
  Pixel& p = pixels_[size_t(y) * size_t(width_) + size_t(x)];
  p.counts[size_t(half)] += samples.count;
  p.weights[size_t(half)] += samples.count;
  p.sums[size_t(half)] += samples.sum;
  p.sumOfSquares += samples.sumOfSquares;
}

void Film::Pixel::add(const Pixel& other) {
  for (size_t half = 0; half < kHalves; ++half) {
    counts[half] += other.counts[half];
    weights[half] += other.weights[half];
    sums[half] += other.sums[half];
  }
  sumOfSquares += other.sumOfSquares;
}

void Film::add(const Film& part, int x, int y) {
  assert(x >= 0 && y >= 0 && x + part.width_ <= width_ && y + part.height_ <= height_);
  if (part.isWeighed() && !isWeighed()) beWeighed();
  for (int row = 0; row < part.height_; ++row)
    for (int column = 0; column < part.width_; ++column) {
      const size_t from = size_t(row) * size_t(part.width_) + size_t(column);
      const size_t to = size_t(y + row) * size_t(width_) + size_t(x + column);
      pixels_[to].add(part.pixels_[from]);
      if (part.early_.empty()) continue;
      early_[to].count += part.early_[from].count;
      early_[to].sum += part.early_[from].sum;
      early_[to].squaredDeviations += part.early_[from].squaredDeviations;
    }
}

void Film::copyPixels(const Film& from, const PixelRect& rect) {
  rect.copy(from.pixels_, pixels_, width_);
  if (isWeighed()) rect.copy(from.early_, early_, width_);
}

Film Film::part(const PixelRect& rect) const {
  Film part(0, 0);
  part.width_ = rect.width, part.height_ = rect.height;
  part.pixels_ = rect.of(pixels_, width_);
  part.early_ = rect.of(early_, width_);
  return part;
}

void Film::archive(Archive& a, Rows rows) {
  a.items(rows.of(pixels_, size_t(width_)));
  if (isWeighed()) a.items(rows.of(early_, size_t(width_)));
}

void Film::weigh(double weight) {
  assert(early_.empty());
  early_.reserve(pixels_.size());
  for (Pixel& p : pixels_) {
    const glm::dvec4 deviations =
        squaredDeviations(p.sumOfSquares, p.sums[0] + p.sums[1], p.count());
    for (size_t half = 0; half < kHalves; ++half) {
      p.weights[half] *= weight;
      p.sums[half] *= weight;
    }
    early_.push_back({uint64_t(p.count()), p.sums[0] + p.sums[1], weight * weight * deviations});
    p.sumOfSquares = glm::dvec4(0);
  }
}

// The squared standard error of the mean if the samples were independent: sum of
// (weight (x - mean))^2 over the squared sum of weights. Early and later samples have their own
// means here.
glm::dvec4 Film::scatter(size_t pixel) const {
  const Pixel& p = pixels_[pixel];
  const Early early = early_.empty() ? Early{} : early_[pixel];
  const glm::dvec4 later = squaredDeviations(p.sumOfSquares, p.sums[0] + p.sums[1] - early.sum,
                                             double(p.count() - early.count));
  return (early.squaredDeviations + later) / (p.weight() * p.weight());
}

Image Film::mean() const {
  Image image(width_, height_, 3);
  forRanges(pixels_.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) image.setRgb(i, Rgb(pixels_[i].mean()));
  });
  return image;
}

Image Film::halfDifference() const {
  Image image(width_, height_, 3);
  for (size_t i = 0; i < pixels_.size(); ++i) {
    const Pixel& p = pixels_[i];
    if (p.counts[0] > 0 && p.counts[1] > 0)
      image.setRgb(i, Rgb((p.sums[0] / p.weights[0] - p.sums[1] / p.weights[1]) / 2.0));
  }
  return image;
}

Image Film::sampleCounts() const {
  Image image(width_, height_, 1);
  for (size_t i = 0; i < pixels_.size(); ++i) image.texels[i] = float(pixels_[i].count());
  return image;
}

double Film::meanSampleCount() const {
  double sum = 0;
  for (const Pixel& pixel : pixels_) sum += pixel.count();
  return sum / double(pixels_.size());
}

PixelErrors Film::errors() const {
  const glm::dvec4 unknown(std::numeric_limits<double>::quiet_NaN());
  const size_t count = pixels_.size();
  PixelErrors errors{width_, height_, longArray<double>(count), longArray<glm::dvec4>(count),
                     longArray<glm::dvec4>(count)};
  forRanges(count, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const Pixel& p = pixels_[i];
      errors.luminances[i] = luminance(p.mean());
      errors.halves[i] = errors.scatter[i] = unknown;
      if (p.counts[0] == 0 || p.counts[1] == 0) continue;
      const double w0 = p.weights[0], w1 = p.weights[1], w = w0 + w1;
      const glm::dvec3 difference = p.sums[0] / w0 - p.sums[1] / w1;
      const glm::dvec4 differences(difference, luminance(difference));
      // Weights are inverse variances. Then
      //   Var(mean of all samples) = w0 w1 / w^2 Var(difference of the means of the halves).
      errors.halves[i] = differences * differences * (w0 * w1 / (w * w));
      errors.scatter[i] = scatter(i);
    }
  });
  return errors;
}

HalvedImage operator-(HalvedImage a, const HalvedImage& b) {
  subtract(a.mean, b.mean);
  subtract(a.half, b.half);
  return a;
}

}  // namespace chromeball
