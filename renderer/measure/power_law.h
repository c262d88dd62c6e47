// SPDX-License-Identifier: Apache-2.0
// Rates of convergence: a power law fitted to errors.
#pragma once

#include <optional>
#include <span>

#include "measure/statistics.h"

namespace chromeball {

struct ConvergencePoint {
  double samples;  // or seconds; > 0
  Estimate error;
};

// error = e^intercept samples^slope. The slope of a variance is -1 for independent samples and less
// for quasi-random ones; the slope of an error tends to 0 where bias dominates.
struct PowerLaw {
  Estimate slope;
  double intercept = 0;
  double meanLog = 0;       // weighted mean of log samples
  double meanVariance = 0;  // squared standard error of the fitted log error at meanLog
  double logAt(double samples) const;
};

// Least squares of log error against log samples. Points are weighted by their inverse variance
// (the variance of log e is that of e over e^2). If they scatter more than their standard errors
// allow, the slope's standard error increases accordingly (Birge 1932). nullopt for fewer than two
// points above 0.
std::optional<PowerLaw> fitPowerLaw(std::span<const ConvergencePoint> points);

// The number of samples at which the variance, by its power law, equals the squared bias; more
// samples gain little. nullopt if the bias is not significant (95%) or the variance does not fall.
struct Crossing {
  double samples, low, high;  // with its 95% confidence interval
};
std::optional<Crossing> biasEqualsNoise(const PowerLaw& variance, const Estimate& squaredBias);

}  // namespace chromeball
