// SPDX-License-Identifier: Apache-2.0
// False colours: maps from numbers to colours, and their scales.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "image/image.h"

namespace chromeball {

using Color8 = std::array<uint8_t, 3>;  // sRGB

// Black, violet, orange, pale yellow for t in [0, 1]. Luminance increases with t, so that the order
// survives a greyscale print. (After `inferno` of Smith and van der Walt, 2015.)
Color8 heatColor(double t);

// Blue, white, red for t in [-1, 1]. (After `RdBu` of Brewer's ColorBrewer.)
Color8 signedColor(double t);

// The position of `number` on a logarithmic scale that ends at `maximum` and spans `decades`:
// clamped to [0, 1].
double logLevel(double number, double maximum, double decades);

// The smallest 1, 2 or 5 times a power of ten that is not below the number: a readable end of a
// scale.
double roundUp(double number);

// The number that about this fraction of the numbers does not exceed. Ignores NaN; 0 if there are
// no numbers.
double percentile(std::vector<float> numbers, double fraction);

// Where an image is noisy: in words, and as a small picture.

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
