// SPDX-License-Identifier: Apache-2.0
// What a PNG says of its colour (ISO/IEC 15948, 11.3.3), for images of light; textures of models
// ignore it (glTF 2.0, 3.8.2).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "image/chromaticities.h"

namespace chromeball {

struct PngColor {
  std::optional<double> exponent;           // a sample is decoded by this power; nullopt: by sRGB
  std::optional<Chromaticities> primaries;  // nullopt: of sRGB
};

// By the chunks gAMA and cHRM, which sRGB and iCCP override. An ICC profile is not read: sRGB.
PngColor pngColor(std::span<const uint8_t> file);

}  // namespace chromeball
