// SPDX-License-Identifier: Apache-2.0
// Radiance images (.hdr, .pic): RGBE texels, flat or in one of the two run-length encodings
// (Ward, "Real Pixels", Graphics Gems II; Radiance's color.c). A texel (r, g, b, e) encodes
// (r, g, b) 2^(e - 136), divided by the factors that the header says it was multiplied by.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "base/message.h"
#include "image/chromaticities.h"
#include "image/image.h"

namespace chromeball {

// The contents of the header's comment lines, "# NAME=VALUE".
using HdrComments = std::map<std::string, std::string>;

struct RadianceHdr {
  Image image;                              // three channels
  std::optional<Chromaticities> primaries;  // of a PRIMARIES line
  HdrComments comments;
  Messages messages;  // about lines that scale texels or are not understood
};

// Texels are divided by the products of EXPOSURE and COLORCORR. Throws InputError.
RadianceHdr readRadianceHdr(const std::filesystem::path& path);

inline constexpr float kMaxRgbe = 255 * 0x1p119f;  // the largest channel of a texel, 1.7e38

// Writes the first three channels, each rounded to the nearest mantissa for the texel's shared
// exponent. RGBE cannot hold negative, infinite or NaN channels: these become 0; channels above
// kMaxRgbe become kMaxRgbe. Throws RunError.
void writeRadianceHdr(const std::filesystem::path& path, const Image& image,
                      const HdrComments& comments = {});

}  // namespace chromeball
