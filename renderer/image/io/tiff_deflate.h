// SPDX-License-Identifier: Apache-2.0
// The checksums of a TIFF's strips and tiles that are compressed by Deflate. libtiff stops at the
// last texel, before the checksum, and has no function that goes on.
#pragma once

#include <cstdint>
#include <span>

namespace chromeball {

// Inflates the blocks of the first image (RFC 1950). Throws std::runtime_error if one is damaged. A
// block without its end, as flushed streams are, has no checksum; texels that it lacks are the
// decoder's to find. Takes time in proportion to the file and its image: hostile blocks, which
// overlap or inflate to more, are left unverified beyond that.
void checkDeflate(std::span<const uint8_t> tiff);

}  // namespace chromeball
