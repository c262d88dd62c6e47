// SPDX-License-Identifier: Apache-2.0
// Decodes WebP by libwebp: OpenImageIO's reader multiplies the colour by alpha, which rounds away
// the colours of transparent texels.
#pragma once

#include "image/io/decode_image.h"
#include "image/io/strip_metadata.h"

namespace chromeball {

// As decodeImage(), for a WebP file.
DecodedImage decodeWebp(std::span<const uint8_t> file, const std::string& name);

// By the header; 0 if it is damaged.
HeaderSize webpSize(std::span<const uint8_t> file);

}  // namespace chromeball
