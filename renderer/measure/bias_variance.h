// SPDX-License-Identifier: Apache-2.0
// How far repeated renders of one picture are from the truth: what is noise, what is bias, and how
// surely that is known.
#pragma once

#include <span>

#include "image/image.h"

namespace chromeball {

struct Estimate {
  double mean = 0, standardError = 0;

  // The ends of the interval that holds the truth in 95 of 100 cases, where errors are normal.
  double low() const { return mean - 1.96 * standardError; }
  double high() const { return mean + 1.96 * standardError; }
};

// What errors are measured against. Its noise is independent of the images judged.
struct Reference {
  Image mean;          // RGB
  Image squaredError;  // squared standard error, RGB; empty where unknown, which counts as none
};

// Relative numbers are means over pixels and channels of (...) / (reference^2 + 0.01); they are
// free of the reference's own variance, and relMse = variance + squaredBias.
struct CellError {
  Estimate relMse;       // of one image
  Estimate variance;     // the part that more samples remove
  Estimate squaredBias;  // the part that stays; an estimate of 0 may come out negative
  Estimate bias;         // mean(image - reference) / mean(reference)
  double mse = 0;        // absolute, of one image
  double reference = 0;  // the reference's own relative variance, which was removed
};

// Three or more independent images of the reference's size, RGB. Takes pixels for independent, as
// this renderer's are; channels of a pixel need not be.
//
// With d the images' mean less the reference, s2 their sample variance and v the reference's
// squared error, d^2 - s2 / R - v is free of bias for the squared bias. The standard error of
// relMse comes from each pixel's scatter over the repeats, that of the variance by the jackknife,
// and that of the squared bias from its variance under normal noise, 4 bias^2 w + 2 w^2, w = s2 / R
// + v.
CellError cellError(std::span<const Image> repeats, const Reference& reference);

}  // namespace chromeball
