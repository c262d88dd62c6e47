// SPDX-License-Identifier: Apache-2.0
// What the render has found so far: per pixel the mean, and how far it may be off.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "film/noise.h"
#include "image/image.h"
#include "math/vec.h"

namespace chromeball {

// Sums over samples of a pixel, in double: a million samples of 1e10 beside 1e-8 neither stall nor
// overflow. Squares are of red, green, blue and luminance.
struct SampleSums {
  uint32_t count = 0;
  glm::dvec3 sum{0};
  glm::dvec4 sumOfSquares{0};

  void add(const Rgb& radiance) {
    const glm::dvec3 rgb(radiance);
    const glm::dvec4 x(rgb, luminance(rgb));
    ++count;
    sum += rgb;
    sumOfSquares += x * x;
  }
};

// Box filter: a pixel is the mean of the samples inside it.
//
// The samples of a pixel belong to two halves, each a quasi-random sequence with a randomisation of
// its own. However many samples there are, the halves are independent, so their difference tells
// the error of their mean without bias; the samples' scatter alone would overstate it.
class Film {
 public:
  static constexpr int kHalves = 2;

  Film(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }

  // Concurrently for different pixels.
  void add(int x, int y, int half, const SampleSums& samples);

  Image mean() const;          // RGB radiance
  Image sampleCounts() const;  // one channel
  static size_t bytesPerPixel() { return sizeof(Pixel); }

  PixelErrors errors() const;
  Noise noise() const { return estimateNoise(errors()); }

 private:
  struct Pixel {
    std::array<uint32_t, kHalves> counts{};
    std::array<glm::dvec3, kHalves> sums{};
    glm::dvec4 sumOfSquares{0};

    uint32_t count() const { return counts[0] + counts[1]; }
    glm::dvec3 mean() const;
  };

  int width_, height_;
  std::vector<Pixel> pixels_;
};

}  // namespace chromeball
