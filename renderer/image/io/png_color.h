// SPDX-License-Identifier: Apache-2.0
// The colour space that a PNG states (ISO/IEC 15948, 11.3.3; cICP: third edition), for images of
// light; textures of models ignore it (glTF 2.0, 3.8.2).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "image/chromaticities.h"
#include "image/io/read_image.h"
#include "image/tonemap.h"

namespace chromeball {

// The linear number that a sample, a fraction of the largest, stands for.
using DecodeSample = std::function<float(float)>;

struct PngColor {
  DecodeSample decode = srgbToLinear;
  std::optional<Chromaticities> primaries = {};  // nullopt: sRGB's
  std::optional<Transfer> transfer = {};         // nullopt: not stated, `decode` is of sRGB
};

// The colour space, from the chunk cICP, else from gAMA and cHRM, which sRGB overrides; they
// approximate an ICC profile (pngProfile()), which takes precedence but is not applied. Throws
// std::runtime_error for a cICP whose samples cannot be decoded here, such as PQ and HLG.
PngColor pngColor(std::span<const uint8_t> file);

}  // namespace chromeball
