// SPDX-License-Identifier: Apache-2.0
// Decodes an image file in memory: the textures of a model.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
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

// Interleaved samples of 8 or 16 bits: one channel (grey), two (grey, alpha), three (RGB) or four
// (RGB, alpha). Alpha is not associated.
struct SampleLayout {
  int width = 0, height = 0, channels = 0, bits = 8;
  bool hasAlpha() const { return channels % 2 == 0; }
};

// Throws if an image of this size must not be read. Called before memory is allocated for it.
using CheckSize = std::function<void(const SampleLayout&)>;

// Decodes a PNG, JPEG or WebP; `name` is for messages, and `check` may be empty. Throws InputError
// for another format, for damaged data, for an image with a side above kMaxImageSide, with more
// texels than the bytes of the file can hold or than fit into memory, and what `check` throws.
DecodedImage decodeImage(std::span<const uint8_t> file, const std::string& name,
                         const CheckSize& check = {});

// Bytes of the arrays that decodeImage() would fill, by the header of the file; 0 if it is damaged,
// or claims more than the file can hold.
uint64_t decodedBytes(std::span<const uint8_t> file);

// PNG and JPEG: files of integer samples, decoded row by row.

// An open file. Metadata is skipped: profiles, EXIF blocks and comments are never parsed.
class SampleReader {
 public:
  // Row `y` from the top; samples of 16 bits are uint16_t.
  using Row = std::function<void(int y, const void* samples)>;

  virtual ~SampleReader() = default;
  const SampleLayout& layout() const { return layout_; }

  // Decodes all rows in turn; once. Throws std::runtime_error with the reason, and passes on
  // exceptions of `row`.
  virtual void read(const Row& row) = 0;

 protected:
  SampleLayout layout_;
};

// These read the header of a file, which must outlive the reader. `check` runs before memory is
// allocated for the image. They throw std::runtime_error with the reason, and pass on exceptions of
// `check`.
//
// Low bit depths become 8 bits, palettes RGB, and transparency alpha.
std::unique_ptr<SampleReader> openPng(std::span<const uint8_t> file, const CheckSize& check);
// CMYK becomes RGB.
std::unique_ptr<SampleReader> openJpeg(std::span<const uint8_t> file, const CheckSize& check);

// Each scan of a progressive JPEG visits every block, even if the scan has only a dozen bytes.
// Encoders write about ten scans.
inline constexpr int kMaxJpegScans = 100;

}  // namespace chromeball
