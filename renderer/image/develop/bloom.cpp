// SPDX-License-Identifier: Apache-2.0
#include "image/develop/bloom.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "math/vec.h"

namespace chromeball {
namespace {

// Lines of an image. Line i of a group begins at `start` + i; its texels are `step` apart.
struct LineGroup {
  size_t start, count, step;
};

// Filters the lines of the groups groupOf(0), groupOf(1), ..., of at most `together` lines. They
// are taken from the image group by group: a column alone would read a whole cache line for each of
// its pixels.
template <class GroupOf>
void blurLines(Image& image, const GaussianLine& gaussian, size_t groups, size_t together,
               size_t length, const GroupOf& groupOf) {
  forRanges(groups, gaussian.work() * length * together, [&](size_t begin, size_t end) {
    std::vector<double> lines(together * length), scratch;
    for (size_t group = begin; group < end; ++group) {
      const auto [start, count, step] = groupOf(group);
      for (size_t k = 0; k < length; ++k)
        for (size_t i = 0; i < count; ++i)
          lines[i * length + k] = double(image.texels[start + k * step + i]);
      for (size_t i = 0; i < count; ++i) gaussian.apply({&lines[i * length], length}, scratch);
      for (size_t k = 0; k < length; ++k)
        for (size_t i = 0; i < count; ++i)
          image.texels[start + k * step + i] = float(lines[i * length + k]);
    }
  });
}

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

void blurGaussian(Image& image, double sigma, GaussianMethod method) {
  if (image.empty() || !(sigma > 0)) return;
  constexpr size_t kTogether = 32;  // columns of one channel
  const size_t channels = size_t(image.channels), width = size_t(image.width),
               height = size_t(image.height), across = width * channels;
  const auto rows = [&](size_t y) { return LineGroup{y * across, channels, channels}; };
  const auto columns = [&](size_t group) {
    const size_t first = group * kTogether;
    return LineGroup{first, std::min(kTogether, across - first), across};
  };
  blurLines(image, GaussianLine(sigma, image.width, method), height, channels, width, rows);
  blurLines(image, GaussianLine(sigma, image.height, method), (across + kTogether - 1) / kTogether,
            kTogether, height, columns);
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
