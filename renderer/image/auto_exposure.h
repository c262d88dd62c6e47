// SPDX-License-Identifier: Apache-2.0
// The exposure that shows a picture's surfaces well: as a camera's meter would choose it.
#pragma once

#include "image/image.h"

namespace chromeball {

// Stops, in steps of 0.1, so that the logarithmic mean of the surfaces' luminances (Reinhard et al.
// 2002, "Photographic tone reproduction for digital images", eq. 1) becomes 0.25, as far as at most
// a twentieth of them clips in a channel. Surfaces are the pixels whose `coverage`, of one channel,
// is at least a half; all pixels if there are none, or if `coverage` is empty. Pixels that are
// black, infinite or NaN are left out, and from the mean also the 2% at either end: few pixels
// decide nothing. 0 if nothing remains.
float autoExposure(const Image& radiance, const Image& coverage = {});

}  // namespace chromeball
