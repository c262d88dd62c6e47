// SPDX-License-Identifier: Apache-2.0
#include "image/develop/bloom.h"

#include <algorithm>

#include "base/parallel.h"

namespace chromeball {
namespace {

// The lines are taken from the image several at a time, channel by channel: a column alone would
// read a whole cache line for each of its pixels.
class Lines {
 public:
  Lines(size_t count, size_t length) : length_(length), texels_(count * length) {}

  std::span<double> operator[](size_t i) { return {&texels_[i * length_], length_}; }

  void filter(const GaussianLine& gaussian, size_t count) {
    for (size_t i = 0; i < count; ++i) gaussian.apply((*this)[i], scratch_);
  }

 private:
  size_t length_;
  std::vector<double> texels_, scratch_;
};

void blurRows(Image& image, const GaussianLine& gaussian) {
  const size_t channels = size_t(image.channels), width = size_t(image.width);
  forRanges(size_t(image.height), gaussian.work() * width * channels,
            [&](size_t begin, size_t end) {
              Lines lines(channels, width);
              for (size_t y = begin; y < end; ++y) {
                float* row = image.at(0, int(y));
                for (size_t c = 0; c < channels; ++c)
                  for (size_t x = 0; x < width; ++x) lines[c][x] = double(row[x * channels + c]);
                lines.filter(gaussian, channels);
                for (size_t c = 0; c < channels; ++c)
                  for (size_t x = 0; x < width; ++x) row[x * channels + c] = float(lines[c][x]);
              }
            });
}

void blurColumns(Image& image, const GaussianLine& gaussian) {
  constexpr size_t kTogether = 32;  // columns of one channel
  const size_t height = size_t(image.height), across = size_t(image.width) * size_t(image.channels);
  const size_t groups = (across + kTogether - 1) / kTogether;
  forRanges(groups, gaussian.work() * height * kTogether, [&](size_t begin, size_t end) {
    Lines lines(kTogether, height);
    for (size_t group = begin; group < end; ++group) {
      const size_t first = group * kTogether, count = std::min(kTogether, across - first);
      for (size_t y = 0; y < height; ++y)
        for (size_t i = 0; i < count; ++i)
          lines[i][y] = double(image.texels[y * across + first + i]);
      lines.filter(gaussian, count);
      for (size_t y = 0; y < height; ++y)
        for (size_t i = 0; i < count; ++i)
          image.texels[y * across + first + i] = float(lines[i][y]);
    }
  });
}

}  // namespace

void blurGaussian(Image& image, double sigma, GaussianMethod method) {
  if (image.empty() || !(sigma > 0)) return;
  blurRows(image, GaussianLine(sigma, image.width, method));
  blurColumns(image, GaussianLine(sigma, image.height, method));
}

Image bloom(const Image& image, const std::vector<WeightedGaussian>& mixture,
            GaussianMethod method) {
  Image sum(image.width, image.height, image.channels);
  for (const WeightedGaussian& part : mixture) {
    Image blurred = image;
    blurGaussian(blurred, part.sigma, method);
    forRanges(sum.texels.size(), [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i)
        sum.texels[i] += float(part.weight * double(blurred.texels[i]));
    });
  }
  return sum;
}

}  // namespace chromeball
