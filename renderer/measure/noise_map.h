// SPDX-License-Identifier: Apache-2.0
// Where an image is noisy: in words, and as a small picture.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "image/image.h"

namespace chromeball {

// The smallest part of the image that most of its noisiest twentieth lies in: "upper left", "top",
// "left half"; empty if it lies all over. `relativeErrors`: one channel; NaN is unknown.
std::string_view noisiestPart(const Image& relativeErrors);

// sRGB, 8 bits.
struct NoiseMap {
  int width, height;
  std::vector<uint8_t> bytes;
};
// At most 320 pixels wide and high: each is the root mean square of a square of pixels, as a
// heatColor() (false_color.h) on a logarithmic scale from 0.1% (black) to 100%; grey where unknown.
NoiseMap noiseMap(const Image& relativeErrors);

}  // namespace chromeball
