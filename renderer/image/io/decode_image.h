// SPDX-License-Identifier: Apache-2.0
// Decodes an image file in memory: the textures of a model.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "math/vec.h"

namespace chromeball {

// RGBA texels, row 0 on top. Alpha is unassociated, as in the file, and 1 if the file has none;
// grey is copied to R, G and B. Exactly one of the arrays is filled. No transfer function is
// applied.
struct DecodedImage {
  int width = 0, height = 0;
  std::vector<std::array<uint8_t, 4>> texels8;  // 8-bit sources
  std::vector<vec4> texelsFloat;                // deeper sources; 0..1 for integer files
};

inline constexpr int kMaxImageSide = 16384;

// Decodes a PNG, JPEG or WebP; `name` is for messages. Throws InputError for another format, for
// damaged data, and for an image with a side above kMaxImageSide or with more texels than the bytes
// of the file can hold.
DecodedImage decodeImage(std::span<const uint8_t> file, const std::string& name);

// Bytes of the arrays that decodeImage() would fill, by the header of the file; 0 if it is damaged,
// or claims more than the file can hold.
uint64_t decodedBytes(std::span<const uint8_t> file);

// Decodes WebP by libwebp.

// As decodeImage(), for a WebP file.
DecodedImage decodeWebp(std::span<const uint8_t> file, const std::string& name);

// As decodedBytes().
uint64_t webpBytes(std::span<const uint8_t> file);

}  // namespace chromeball
