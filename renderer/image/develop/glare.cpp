// SPDX-License-Identifier: Apache-2.0
#include "image/develop/glare.h"

#include <cmath>
#include <numbers>

#include "math/vec.h"

namespace chromeball {
namespace {

constexpr double kCore = 0.02;  // degrees: of f0, f1 and f2
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
  // s = 1 / (2 sigma^2) by equal steps of its logarithm; a Gaussian has the integral pi / s.
  for (double sigma = widest; sigma > 0 && sigma >= narrowest; sigma /= kRatio) {
    const double s = 1 / (2 * sigma * sigma), step = 2 * std::log(kRatio);
    const double density = kWeights[1] * kFactors[1] * gaussianDensity(3, s) +
                           kWeights[2] * kFactors[2] * gaussianDensity(2, s);
    add(density * step * kPiD * kDegree2, sigma);
  }
  return mixture;
}

}  // namespace chromeball
