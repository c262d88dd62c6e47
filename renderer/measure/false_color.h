// SPDX-License-Identifier: Apache-2.0
// Colours that stand for a number.
#pragma once

#include <array>

#include "image/image.h"

namespace chromeball {

using Color8 = std::array<uint8_t, 3>;  // sRGB

// From black over violet and orange to pale yellow, t in [0, 1]; luminance grows with t, so that a
// grey print keeps the order. (After `inferno` of Smith and van der Walt, 2015.)
Color8 heatColor(double t);

// Blue, white, red for t in [-1, 1]. (After `RdBu` of Brewer's ColorBrewer.)
Color8 signedColor(double t);

// Where `number` stands in a logarithmic scale of `decades` below `maximum`, in [0, 1].
double logLevel(double number, double maximum, double decades);

// 1, 2 or 5 times a power of ten, not below the number: the end of a scale that people can read.
double roundUp(double number);

// The number that a share of all numbers does not exceed; NaN sorts nowhere. 0 where there are
// none.
double percentile(std::vector<float> numbers, double fraction);

}  // namespace chromeball
