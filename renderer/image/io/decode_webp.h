// SPDX-License-Identifier: Apache-2.0
// WebP, by its own library: OpenImageIO's reader multiplies the colour by alpha, which rounds
// transparent colours away.
#pragma once

#include "image/io/decode_image.h"

namespace chromeball {

// As decodeImage(); `file` begins as a WebP does.
DecodedImage decodeWebp(std::span<const uint8_t> file, const std::string& name);

}  // namespace chromeball
