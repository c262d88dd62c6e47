// SPDX-License-Identifier: Apache-2.0
// Radiance pictures (.hdr, .pic): RGBE texels, flat or in either of the two run-length encodings
// (Ward, "Real Pixels", Graphics Gems II; Radiance's color.c). A texel (r, g, b, e) stands for
// (r, g, b) 2^(e - 136), divided by the product of the header's EXPOSURE lines.
#pragma once

#include <filesystem>

#include "image/image.h"

namespace chromeball {

// Three channels. Throws InputError.
Image readRadianceHdr(const std::filesystem::path& path);

// The first three channels, each rounded to the nearest mantissa of the texel's shared exponent.
// RGBE holds nothing negative and nothing invalid: such channels are written as 0. Throws RunError.
void writeRadianceHdr(const std::filesystem::path& path, const Image& image);

}  // namespace chromeball
