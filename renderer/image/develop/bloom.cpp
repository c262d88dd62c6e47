// SPDX-License-Identifier: Apache-2.0
#include "image/develop/bloom.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "math/vec.h"

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

namespace {

constexpr double kCore = 0.02;  // degrees; the arrays are for f0, f1 and f2
constexpr double kWeights[] = {0.384, 0.478, 0.138};
constexpr double kFactors[] = {2.61e6, 20.91, 72.37};
constexpr double kDegree2 = kPiD / 180 * (kPiD / 180);  // steradians

// The integral of v^n exp(-b v - v^2) over v from 0.
double moment(int n, double b) {
  constexpr int kSteps = 4000;
  const double end = std::min(7.0, 40 / (b + 1e-9)), step = end / kSteps;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double v = (i + 0.5) * step;
    sum += std::pow(v, n) * std::exp(-b * v - v * v);
  }
  return sum * step;
}

// W with (x + a)^-n = integral of W(s) exp(-s x^2) over s from 0, for x >= 0: the Laplace
// transforms of t^(n-1) e^-ta / (n-1)! and of exp(-t x) = integral of t / (2 sqrt(pi s^3)) exp(-t^2
// / 4s) exp(-s x^2) over s, with t = 2 v sqrt(s).
double gaussianDensity(int n, double s) {
  const double root = std::sqrt(s);
  return std::pow(2 * root, n + 1) * moment(n, 2 * kCore * root) /
         (2 * std::sqrt(kPiD) * s * root * std::tgamma(n));
}

}  // namespace

double spencerSpread(double angle) {
  const double x = angle / kCore, y = angle + kCore;
  return kWeights[0] * kFactors[0] * std::exp(-x * x) + kWeights[1] * kFactors[1] / (y * y * y) +
         kWeights[2] * kFactors[2] / (y * y);
}

std::vector<WeightedGaussian> spencerGlare(double pixelsPerDegree) {
  constexpr double kRatio = 1.7, kWidest = 30, kNarrowest = 0.1;
  const double widest = std::min(kWidest, kMaxSigma / pixelsPerDegree);
  const double narrowest = kNarrowest / pixelsPerDegree;
  std::vector<WeightedGaussian> mixture{{1, 0}};
  const auto add = [&](double weight, double sigma) {
    mixture.push_back({weight, sigma * pixelsPerDegree});
    mixture.front().weight -= weight;
  };
  if (const double core = kCore / std::numbers::sqrt2; core >= narrowest && core <= widest)
    add(kWeights[0], core);
  // Steps s = 1 / (2 sigma^2) equally in its logarithm; a Gaussian has the integral pi / s.
  for (double sigma = widest; sigma > 0 && sigma >= narrowest; sigma /= kRatio) {
    const double s = 1 / (2 * sigma * sigma), step = 2 * std::log(kRatio);
    const double density = kWeights[1] * kFactors[1] * gaussianDensity(3, s) +
                           kWeights[2] * kFactors[2] * gaussianDensity(2, s);
    add(density * step * kPiD * kDegree2, sigma);
  }
  return mixture;
}

}  // namespace chromeball
