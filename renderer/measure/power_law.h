// SPDX-License-Identifier: Apache-2.0
// How fast an error falls: a straight line through logarithms.
#pragma once

#include <optional>
#include <span>

#include "measure/bias_variance.h"

namespace chromeball {

struct ConvergencePoint {
  double samples;  // or seconds; > 0
  Estimate error;
};

// error = e^intercept samples^slope: -1 for independent samples in variance, steeper for
// quasi-random ones, 0 where bias has taken over.
struct PowerLaw {
  Estimate slope;
  double intercept = 0;
  double meanLog = 0;       // of the samples, weighted
  double meanVariance = 0;  // squared standard error of the fitted logarithm there
  double logAt(double samples) const;
};

// Least squares of log error against log samples, each point weighing as it is sure (the squared
// error of log e is that of e over e^2). Where points scatter more than their errors allow, the
// slope's error grows accordingly (Birge 1932). nullopt for fewer than two points above 0.
std::optional<PowerLaw> fitPowerLaw(std::span<const ConvergencePoint> points);

// The number of samples at which the variance, by its power law, has fallen to the squared bias:
// more of them gain little. nullopt where the bias is not sure (95%), or variance does not fall.
struct Crossing {
  double samples, low, high;  // with the interval of 95%
};
std::optional<Crossing> biasEqualsNoise(const PowerLaw& variance, const Estimate& squaredBias);

// The mean of estimates of one number, each weighing as it is sure.
Estimate combine(std::span<const Estimate> estimates);

}  // namespace chromeball
