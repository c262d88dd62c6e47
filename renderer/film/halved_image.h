// SPDX-License-Identifier: Apache-2.0
// An image from two independent halves of each pixel's samples (Film).
#pragma once

#include "image/image.h"

namespace chromeball {

// The mean of all samples, and half the difference of the means of the two halves. The square of
// the latter is an unbiased estimate of the squared error of `mean`, if both halves have as many
// samples.
struct HalvedImage {
  Image mean, half;
};

HalvedImage operator-(HalvedImage a, const HalvedImage& b);

}  // namespace chromeball
