// SPDX-License-Identifier: Apache-2.0
#include "image/io/png_color.h"

#include <array>
#include <cmath>

#include "image/io/metadata_blocks.h"

namespace chromeball {
namespace {

// Numbers of chunks are multiples of 1/100000.
template <size_t kCount>
std::optional<std::array<double, kCount>> numbersIn(std::span<const uint8_t> chunk) {
  if (chunk.size() != 4 * kCount) return {};
  std::array<double, kCount> numbers;
  for (size_t i = 0; i < kCount; ++i) {
    const uint8_t* b = &chunk[4 * i];
    numbers[i] = double(uint32_t(b[0]) << 24 | b[1] << 16 | b[2] << 8 | b[3]) / 100000;
  }
  return numbers;
}

}  // namespace

PngColor pngColor(std::span<const uint8_t> file) {
  if (!pngChunk(file, "sRGB").empty() || !pngChunk(file, "iCCP").empty()) return {};
  PngColor color;
  // What writers of sRGB state is 1/2.2, a power near its curve.
  constexpr double kOfSrgb = 1 / 2.2, kTolerance = 0.05;
  if (const auto gamma = numbersIn<1>(pngChunk(file, "gAMA"));
      gamma && (*gamma)[0] > 0 && std::abs((*gamma)[0] / kOfSrgb - 1) > kTolerance)
    color.exponent = 1 / (*gamma)[0];
  if (const auto n = numbersIn<8>(pngChunk(file, "cHRM")))
    color.primaries = Chromaticities{
        {(*n)[2], (*n)[3]}, {(*n)[4], (*n)[5]}, {(*n)[6], (*n)[7]}, {(*n)[0], (*n)[1]}};
  return color;
}

}  // namespace chromeball
