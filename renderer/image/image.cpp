// SPDX-License-Identifier: Apache-2.0
#include "image/image.h"

#include "base/long_array.h"

namespace chromeball {

Image::Image(int w, int h, int c)
    : width(w), height(h), channels(c), texels(longArray<float>(size_t(w) * h * c)) {}

}  // namespace chromeball
