// SPDX-License-Identifier: Apache-2.0
#include "measure/power_law.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace chromeball {
namespace {

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
