// SPDX-License-Identifier: Apache-2.0
// Decodes an image file that is already in memory.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "math/vec.h"

namespace chromeball {

// RGBA texels, row 0 on top, alpha unassociated (as the file states it) and 1 where the file has
// none; grey is spread over RGB. Exactly one of the arrays is filled. Values are as encoded: no
// transfer function is applied.
struct DecodedImage {
  int width = 0, height = 0;
  std::vector<std::array<uint8_t, 4>> texels8;  // 8-bit sources
  std::vector<vec4> texelsFloat;                // deeper sources; 0..1 for integer files
};

inline constexpr int kMaxImageSide = 16384;

// `file` holds a PNG, a JPEG or a WebP; `name` is for messages. Throws InputError for another
// format, an image larger than kMaxImageSide on a side or than its bytes can hold, and for damaged
// data.
DecodedImage decodeImage(std::span<const uint8_t> file, const std::string& name);

}  // namespace chromeball
