// SPDX-License-Identifier: Apache-2.0
// Splits the error of repeated renders into variance and bias, with confidence intervals.
#pragma once

#include <optional>
#include <span>

#include "image/image.h"
#include "measure/statistics.h"

namespace chromeball {

// The reference image. Its noise is independent of the images that are compared with it.
struct Reference {
  Image mean;          // RGB
  Image squaredError;  // squared standard error, RGB; empty if unknown, which counts as 0
};

// relMse, variance and squaredBias are means over pixels and channels of (...) / (reference^2 +
// 0.01), without the variance of the reference itself: relMse = variance + squaredBias.
struct BiasVariance {
  Estimate relMse;                // of one image
  Estimate variance;              // the part that more samples reduce
  Estimate squaredBias;           // the part that remains; its estimate may be negative
  Estimate bias;                  // mean(image - reference) / mean(reference)
  double mse = 0;                 // of one image; absolute, not relative
  double referenceVariance = 0;   // relative, of the reference; it has been subtracted
  double referenceBiasError = 0;  // the part of squaredBias.standardError that its noise causes
};

// Whether the errors of the pixels of an image are independent of each other.
enum class PixelNoise {
  Independent,  // as this renderer's are; the channels of a pixel need not be
  Joined,       // a filter or records shared by pixels (denoising, irradiance cache) join them
};

// `repeats`: at least three independent RGB images of the reference's size.
//
// With d = mean of the R images - reference, s2 = their sample variance, v = squared error of the
// reference and w = s2 / R + v, the squared bias is estimated by d^2 - w, without bias. With
// independent noise the standard error of relMse comes from each pixel's mean over the repeats, the
// one of the variance from the jackknife, and the one of the squared bias from its variance under
// normal noise, 4 bias^2 w + 2 w^2; with joined noise all come from the jackknife over the repeats,
// with R - 1 degrees of freedom.
BiasVariance biasVariance(std::span<const Image> repeats, const Reference& reference,
                          PixelNoise noise = PixelNoise::Independent);

// The mean of one squared bias over images of several budgets, weighted by inverse variances. The
// error that the reference causes is the same in all of them, so that no mean reduces it.
Estimate commonSquaredBias(std::span<const BiasVariance> errors);

// Rates of convergence: a power law fitted to errors.

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

// A least-squares fit of log error against log samples. Points are weighted by their inverse
// variance (the variance of log e is the variance of e over e^2). If they scatter more than their
// standard errors allow, the slope's standard error increases accordingly (Birge 1932). nullopt for
// fewer than two points above 0.
std::optional<PowerLaw> fitPowerLaw(std::span<const ConvergencePoint> points);

// The number of samples at which the variance, by its power law, equals the squared bias; more
// samples gain little. nullopt if the bias is not significant (95%) or the variance does not fall.
struct Crossing {
  double samples, low, high;  // with its 95% confidence interval
};
std::optional<Crossing> biasEqualsNoise(const PowerLaw& variance, const Estimate& squaredBias);

}  // namespace chromeball
