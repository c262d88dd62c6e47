// SPDX-License-Identifier: Apache-2.0
// The transmission of a filter in front of a camera.
#pragma once

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

struct FilterTransmission {
  dvec3 transmission;  // sum with / sum without, over the pixels
  dvec3 median;        // of the pixels' ratios: differs if something moved, or light leaks in
  size_t pixels = 0;
};

// From linear images of one view with and without the filter (HDRI book, section 9.3.5), of one
// size, with three channels. Masks (one channel; may be null) are not 0 where radiance is only a
// bound; these pixels are left out, and those with a channel that is not above 0. Throws InputError
// if none is left.
FilterTransmission filterTransmission(const Image& with, const Image* clippedWith,
                                      const Image& without, const Image* clippedWithout);

}  // namespace chromeball
