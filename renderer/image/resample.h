// SPDX-License-Identifier: Apache-2.0
// Images of another size.
#pragma once

#include "image/image.h"

namespace chromeball {

// With a box filter: each pixel has the mean of what it covers. An image of the requested size is
// returned unchanged.
Image resampled(const Image& image, int width, int height);

}  // namespace chromeball
