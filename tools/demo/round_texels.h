// SPDX-License-Identifier: Apache-2.0
// Smaller files for paintings.
#pragma once

#include "image/image.h"

namespace chromeball::demo {

// Eleven significant bits are plenty for a painting, and make the file a third as large.
inline void roundTexels(Image& image) {
  for (float& texel : image.texels) {
    int exponent;
    const float fraction = std::frexp(texel, &exponent);
    texel = std::ldexp(std::round(fraction * 2048) / 2048, exponent);
  }
}

}  // namespace chromeball::demo
