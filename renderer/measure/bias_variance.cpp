// SPDX-License-Identifier: Apache-2.0
#include "measure/bias_variance.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include <boost/math/distributions/students_t.hpp>

namespace chromeball {
namespace {

constexpr int kChannels = 3;

double squared(double x) { return x * x; }

// Sums over pixels and channels.
struct Sums {
  double relMse = 0, variance = 0, squaredBias = 0, difference = 0, reference = 0, mse = 0,
         referenceVariance = 0;
  // Squared standard errors of the sums above.
  double relMseError = 0, varianceError = 0, squaredBiasError = 0, differenceError = 0;
  double referenceBiasError = 0;  // the part of squaredBiasError that the reference's noise causes
};

// The squared standard error of the mean of `numbers`: unbiased sample variance / count.
double squaredErrorOfMean(std::span<const double> numbers) {
  double mean = 0, scatter = 0;
  const double n = double(numbers.size());
  for (const double x : numbers) mean += x / n;
  for (const double x : numbers) scatter += squared(x - mean);
  return scatter / (n - 1) / n;
}

class PixelSums {
 public:
  // With PixelNoise::Joined the errors are those that the reference's noise causes, which is
  // independent.
  PixelSums(std::span<const Image> repeats, const Reference& reference, PixelNoise noise)
      : repeats_(repeats),
        reference_(reference),
        noise_(noise),
        n_(double(repeats.size())),
        squaredErrors_(repeats.size()),
        deviations_(repeats.size()) {}

  void add(size_t pixel) {
    std::fill(squaredErrors_.begin(), squaredErrors_.end(), 0);
    std::fill(deviations_.begin(), deviations_.end(), 0);
    double biasError = 0, referenceBiasError = 0, differenceError = 0, crossError = 0;
    for (size_t i = pixel * kChannels; i < (pixel + 1) * kChannels; ++i) {
      const double truth = reference_.mean.texels[i];
      const double v = reference_.squaredError.empty() ? 0 : reference_.squaredError.texels[i];
      const double weight = 1 / (truth * truth + 0.01);
      double mean = 0, scatter = 0;
      for (const Image& image : repeats_) mean += image.texels[i] / n_;
      for (size_t r = 0; r < repeats_.size(); ++r) {
        const double x = repeats_[r].texels[i];
        scatter += squared(x - mean);
        deviations_[r] += weight * squared(x - mean);
        squaredErrors_[r] += weight * squared(x - truth);
        sums_.mse += (squared(x - truth) - v) / n_;
      }
      const double s2 = scatter / (n_ - 1), d = mean - truth, w = s2 / n_ + v;
      sums_.variance += weight * s2;
      sums_.squaredBias += weight * (d * d - w);
      sums_.relMse += weight * (d * d - w + s2);
      sums_.referenceVariance += weight * v;
      sums_.difference += d;
      sums_.reference += truth;
      // 4 bias^2 w + 2 w^2 = E[4 d^2 w] - 2 w^2, since E[4 d^2 w] = 4 bias^2 w + 4 w^2. In w^2 the
      // square s2^2 is corrected, since E[s2^2] = (R + 1) / (R - 1) variance^2.
      const double w2 = squared(s2 / n_) * (n_ - 1) / (n_ + 1) + v * v + 2 * v * s2 / n_;
      biasError += weight * std::sqrt(std::max(0.0, 4 * d * d * w - 2 * w2));
      // The reference's part of that: 4 bias^2 v + 2 v^2.
      referenceBiasError +=
          weight * std::sqrt(std::max(0.0, 4 * d * d * v - 4 * w * v + 2 * v * v));
      crossError += weight * 2 * std::fabs(d) * std::sqrt(v);
      differenceError += std::sqrt(noise_ == PixelNoise::Joined ? v : w);
    }
    sums_.relMseError += squared(crossError);
    sums_.referenceBiasError += squared(referenceBiasError);
    sums_.differenceError += squared(differenceError);
    if (noise_ == PixelNoise::Joined) {
      sums_.squaredBiasError += squared(referenceBiasError);
      return;
    }
    sums_.relMseError += squaredErrorOfMean(squaredErrors_);
    sums_.varianceError += squared(n_ / (n_ - 2)) * squaredErrorOfMean(deviations_);
    sums_.squaredBiasError += squared(biasError);
  }

  const Sums& sums() const { return sums_; }

 private:
  std::span<const Image> repeats_;
  const Reference& reference_;
  PixelNoise noise_;
  double n_;
  std::vector<double> squaredErrors_, deviations_;  // of the current pixel, one for each repeat
  Sums sums_;
};

Sums sumsOf(std::span<const Image> repeats, const Reference& reference, PixelNoise noise) {
  PixelSums pixels(repeats, reference, noise);
  for (size_t pixel = 0; pixel < reference.mean.texels.size() / kChannels; ++pixel)
    pixels.add(pixel);
  return pixels.sums();
}

// Adds the squared errors that the repeats' noise causes in `sums`, from the jackknife over whole
// repeats: with S(r) the sum without repeat r, (R - 1) / R times the scatter of S(r) (Efron and
// Stein 1981). With few repeats it is itself uncertain: errors are enlarged by Student's quantile,
// so that 1.96 of them are a 95% interval.
void addJackknife(Sums& sums, std::span<const Image> repeats, const Reference& reference) {
  const size_t count = repeats.size();
  std::vector<Sums> without;
  for (size_t r = 0; r < count; ++r) {
    std::vector<Image> others(repeats.begin(), repeats.end());
    others.erase(others.begin() + std::ptrdiff_t(r));
    without.push_back(sumsOf(others, reference, PixelNoise::Joined));
  }
  const double n = double(count);
  const boost::math::students_t student(n - 1);
  const double factor = squared((n - 1) * boost::math::quantile(student, 0.975) / 1.96);
  const auto squaredError = [&](double Sums::*member) {
    std::vector<double> numbers;
    for (const Sums& s : without) numbers.push_back(s.*member);
    return factor * squaredErrorOfMean(numbers);
  };
  sums.relMseError += squaredError(&Sums::relMse);
  sums.varianceError += squaredError(&Sums::variance);
  sums.squaredBiasError += squaredError(&Sums::squaredBias);
  sums.differenceError += squaredError(&Sums::difference);
}

// Lower bound of relative standard errors, which keeps a single point from dominating the fit.
constexpr double kMinRelativeError = 1e-3;

struct LogPoint {
  double x, y, weight;
};

std::vector<LogPoint> logarithms(std::span<const ConvergencePoint> points) {
  std::vector<LogPoint> logs;
  for (const ConvergencePoint& point : points) {
    if (!(point.error.mean > 0) || !(point.samples > 0)) continue;
    const double relative =
        std::max(point.error.standardError / point.error.mean, kMinRelativeError);
    logs.push_back(
        {std::log(point.samples), std::log(point.error.mean), 1 / (relative * relative)});
  }
  return logs;
}

}  // namespace

BiasVariance biasVariance(std::span<const Image> repeats, const Reference& reference,
                          PixelNoise noise) {
  assert(repeats.size() >= 3);
  Sums sums = sumsOf(repeats, reference, noise);
  if (noise == PixelNoise::Joined) addJackknife(sums, repeats, reference);

  const double n = double(reference.mean.texels.size());
  BiasVariance error;
  error.relMse = {sums.relMse / n, std::sqrt(sums.relMseError) / n};
  error.variance = {sums.variance / n, std::sqrt(sums.varianceError) / n};
  error.squaredBias = {sums.squaredBias / n, std::sqrt(sums.squaredBiasError) / n};
  error.bias = {sums.difference / sums.reference,
                std::sqrt(sums.differenceError) / std::fabs(sums.reference)};
  error.mse = sums.mse / n;
  error.referenceVariance = sums.referenceVariance / n;
  error.referenceBiasError = std::sqrt(sums.referenceBiasError) / n;
  return error;
}

Estimate commonSquaredBias(std::span<const BiasVariance> errors) {
  double weights = 0;
  for (const BiasVariance& e : errors)
    if (e.squaredBias.standardError > 0) weights += 1 / squared(e.squaredBias.standardError);
  Estimate bias;
  double own = 0, ofReference = 0;
  for (const BiasVariance& e : errors) {
    const double squaredError = squared(e.squaredBias.standardError);
    if (!(squaredError > 0)) continue;
    const double weight = 1 / squaredError / weights;
    bias.mean += weight * e.squaredBias.mean;
    own += squared(weight) * std::max(0.0, squaredError - squared(e.referenceBiasError));
    ofReference += weight * e.referenceBiasError;
  }
  bias.standardError = std::sqrt(own + squared(ofReference));
  return bias;
}

double PowerLaw::logAt(double samples) const { return intercept + slope.mean * std::log(samples); }

std::optional<PowerLaw> fitPowerLaw(std::span<const ConvergencePoint> points) {
  const std::vector<LogPoint> logs = logarithms(points);
  double weights = 0, meanX = 0, meanY = 0;
  for (const LogPoint& p : logs) {
    weights += p.weight;
    meanX += p.weight * p.x;
    meanY += p.weight * p.y;
  }
  meanX /= weights;
  meanY /= weights;
  double xx = 0, xy = 0;
  for (const LogPoint& p : logs) {
    xx += p.weight * (p.x - meanX) * (p.x - meanX);
    xy += p.weight * (p.x - meanX) * (p.y - meanY);
  }
  if (logs.size() < 2 || !(xx > 0)) return std::nullopt;

  PowerLaw law;
  law.slope.mean = xy / xx;
  law.intercept = meanY - law.slope.mean * meanX;
  double chiSquare = 0;
  for (const LogPoint& p : logs) {
    const double residual = p.y - law.intercept - law.slope.mean * p.x;
    chiSquare += p.weight * residual * residual;
  }
  const double birge = logs.size() > 2 ? std::max(1.0, chiSquare / (double(logs.size()) - 2)) : 1.0;
  law.slope.standardError = std::sqrt(birge / xx);
  law.meanLog = meanX;
  law.meanVariance = birge / weights;
  return law;
}

std::optional<Crossing> biasEqualsNoise(const PowerLaw& variance, const Estimate& squaredBias) {
  if (!(squaredBias.low() > 0) || !(variance.slope.high() < 0)) return std::nullopt;
  const double log = (std::log(squaredBias.mean) - variance.intercept) / variance.slope.mean;
  const double lineError =
      variance.meanVariance + std::pow((log - variance.meanLog) * variance.slope.standardError, 2);
  const double biasError = std::pow(squaredBias.standardError / squaredBias.mean, 2);
  const double error = std::sqrt(lineError + biasError) / -variance.slope.mean;
  return Crossing{std::exp(log), std::exp(log - 1.96 * error), std::exp(log + 1.96 * error)};
}

}  // namespace chromeball
