// SPDX-License-Identifier: Apache-2.0
#include "image/develop/bloom.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chromeball {
namespace {

constexpr double kReach = 6;            // sigmas; 2e-9 of the kernel are beyond
constexpr double kMinReducedSigma = 4;  // of the reduced line, in its pixels
constexpr int kSplineReach = 2;         // a cubic B-spline takes two pixels on each side

void normalize(std::vector<double>& taps) {
  double sum = taps[0];
  for (size_t d = 1; d < taps.size(); ++d) sum += 2 * taps[d];
  for (double& tap : taps) tap /= sum;
}

std::vector<double> integralTaps(double sigma) {
  const int reach = int(std::ceil(kReach * sigma + 0.5));
  const auto below = [&](double x) { return std::erfc(x / (std::numbers::sqrt2 * sigma)); };
  std::vector<double> taps;
  for (int d = 0; d <= reach; ++d) taps.push_back((below(d - 0.5) - below(d + 0.5)) / 2);
  normalize(taps);
  return taps;
}

std::vector<double> sampledTaps(double sigma) {
  std::vector<double> taps;
  for (int d = 0; d <= int(std::ceil(kReach * sigma)); ++d)
    taps.push_back(std::exp(-0.5 * (d / sigma) * (d / sigma)));
  normalize(taps);
  return taps;
}

}  // namespace

GaussianLine::GaussianLine(double sigma, int length, GaussianMethod method) {
  if (!(sigma > 0)) return;
  if (method == GaussianMethod::Fast && sigma > kMaxExactSigma) {
    while (sigma >= 2 * kMinReducedSigma * factor_) factor_ *= 2;
    const double f2 = double(factor_) * factor_;
    taps_ = sampledTaps(std::sqrt((sigma * sigma + 1.0 / 12) / f2 - 2.0 / 3));
    for (int phase = 0; phase < factor_; ++phase) phases_.push_back(splinePhase(phase, factor_));
    work_ = 16 + 2 * taps_.size() / size_t(factor_);
  } else {
    taps_ = integralTaps(sigma);
    foldTaps(length);
    work_ = 2 * taps_.size();
  }
}

// A mirrored line has the period 2 x length: taps that reach further are added to nearer ones. The
// distances of a whole half period to both sides are the same pixel.
void GaussianLine::foldTaps(int length) {
  if (int(taps_.size()) <= length) return;
  const int64_t period = 2 * int64_t(length);
  std::vector<double> folded(size_t(length) + 1, 0.0);
  for (int64_t d = 0; d < int64_t(taps_.size()); ++d) {
    const int64_t rest = d % period;
    const double both = (d == 0 ? 1 : 2) * taps_[size_t(d)];
    folded[size_t(std::min(rest, period - rest))] += both;
  }
  for (size_t d = 1; d < folded.size(); ++d) folded[d] /= 2;
  taps_ = std::move(folded);
}

// The pixel is at u = (phase + 1/2) / factor - 1/2 from the reduced pixel that contains it.
GaussianLine::Phase GaussianLine::splinePhase(int phase, int factor) {
  const double u = (phase + 0.5) / factor - 0.5, floor = std::floor(u);
  const double t = u - floor, t2 = t * t, t3 = t2 * t;
  return {int(floor) - 1,
          {(1 - 3 * t + 3 * t2 - t3) / 6, (4 - 6 * t2 + 3 * t3) / 6,
           (1 + 3 * t + 3 * t2 - 3 * t3) / 6, t3 / 6}};
}

void GaussianLine::applyTaps(std::span<const double> extended, std::span<double> filtered) const {
  const size_t reach = taps_.size() - 1;
  const double* centre = extended.data() + reach;
  for (size_t i = 0; i < filtered.size(); ++i) filtered[i] = taps_[0] * centre[i];
  for (size_t d = 1; d <= reach; ++d) {
    const double tap = taps_[d];
    const double *before = centre - d, *after = centre + d;
    for (size_t i = 0; i < filtered.size(); ++i) filtered[i] += tap * (before[i] + after[i]);
  }
}

void GaussianLine::applyExact(std::span<double> line, std::vector<double>& scratch) const {
  const int reach = int(taps_.size()) - 1, n = int(line.size());
  scratch.resize(size_t(n) + 2 * size_t(reach));
  for (int i = -reach; i < n + reach; ++i)
    scratch[size_t(i + reach)] = line[size_t(mirrored(i, n))];
  applyTaps(scratch, line);
}

void GaussianLine::applyFast(std::span<double> line, std::vector<double>& scratch) const {
  const int reach = int(taps_.size()) - 1, n = int(line.size()), f = factor_;
  const int first = -kSplineReach;                            // reduced pixel of `filtered`
  const int count = (n - 1) / f + 1 + 2 * kSplineReach;       // number of them
  const int begin = first - reach - 2 * kSplineReach;         // reduced pixel of `sums`
  const int extended = count + 2 * reach + 4 * kSplineReach;  // likewise; 4 at each end are cut
  scratch.assign(size_t(extended + count), 0.0);
  const std::span<double> sums(scratch.data(), size_t(extended));
  const std::span<double> filtered(scratch.data() + extended, size_t(count));
  for (int k = begin + 2; k + 2 < begin + extended; ++k)
    for (int phase = 0; phase < f; ++phase) {
      const auto& [offset, weights] = phases_[size_t(phase)];
      const double texel = line[size_t(mirrored(int64_t(k) * f + phase, n))] / f;
      double* to = &sums[size_t(k + offset - begin)];
      for (size_t i = 0; i < 4; ++i) to[i] += weights[i] * texel;
    }
  applyTaps(sums.subspan(2 * kSplineReach), filtered);
  for (int i = 0; i < n; ++i) {
    const auto& [offset, weights] = phases_[size_t(i % f)];
    const double* from = &filtered[size_t(i / f + offset - first)];
    line[size_t(i)] =
        weights[0] * from[0] + weights[1] * from[1] + weights[2] * from[2] + weights[3] * from[3];
  }
}

void GaussianLine::apply(std::span<double> line, std::vector<double>& scratch) const {
  if (taps_.empty()) return;
  factor_ == 1 ? applyExact(line, scratch) : applyFast(line, scratch);
}

}  // namespace chromeball
