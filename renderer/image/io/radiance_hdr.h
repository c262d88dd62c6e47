// SPDX-License-Identifier: Apache-2.0
// Radiance images (.hdr, .pic): RGBE texels, flat or in one of the two run-length encodings
// (Ward, "Real Pixels", Graphics Gems II; Radiance's color.c). A texel (r, g, b, e) encodes
// (r, g, b) 2^(e - 136), divided by the product of the EXPOSURE lines in the header.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "image/image.h"

namespace chromeball {

// What comment lines of the header, "# NAME=VALUE", say.
using HdrComments = std::map<std::string, std::string>;

// Three channels; also the comments, if asked for. Throws InputError.
Image readRadianceHdr(const std::filesystem::path& path, HdrComments* comments = nullptr);

// Writes the first three channels, each rounded to the nearest mantissa for the texel's shared
// exponent. RGBE cannot hold negative, infinite or NaN channels: these become 0. Throws RunError.
void writeRadianceHdr(const std::filesystem::path& path, const Image& image,
                      const HdrComments& comments = {});

}  // namespace chromeball
