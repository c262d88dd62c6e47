// SPDX-License-Identifier: Apache-2.0
// Decodes WebP by libwebp.
#pragma once

#include "image/io/decode_image.h"

namespace chromeball {

// As decodeImage(), for a WebP file.
DecodedImage decodeWebp(std::span<const uint8_t> file, const std::string& name);

// As decodedBytes().
uint64_t webpBytes(std::span<const uint8_t> file);

}  // namespace chromeball
