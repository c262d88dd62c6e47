// What the render has found so far: per pixel the mean, and how far it may be off.
#pragma once

#include <cstdint>
#include <vector>

#include "image/image.h"
#include "math/vec.h"

namespace chromeball {

// Sums over samples that share one randomisation (a block), in double: a million samples of 1e10
// beside 1e-8 neither stall nor overflow. Red, green, blue and luminance.
struct SampleSums {
  uint32_t count = 0;
  glm::dvec4 sum{0}, sumOfSquares{0};

  void add(const Rgb& radiance) {
    const glm::dvec4 x(radiance, luminance(radiance));
    ++count;
    sum += x;
    sumOfSquares += x * x;
  }
};

// Box filter: a pixel is the mean of the samples inside it.
//
// The samples of a block are quasi-random, so their scatter overstates the error of their mean; the
// scatter of independent blocks' means is true but rests on few numbers. So the standard error of a
// pixel is its samples' scatter, times the ratio of both measures over the 7 x 7 pixels around it.
class Film {
 public:
  Film(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }

  // Pixels may be added to concurrently, each by one thread.
  void addBlock(int x, int y, const SampleSums& block);

  Image mean() const;                    // RGB radiance
  Image squaredStandardError() const;    // of each pixel's mean, RGB
  Image sampleCounts() const;            // one channel
  static size_t bytesPerPixel() { return sizeof(Pixel); }

  // Mean over pixels of s / max(m, 0.01 M): s the standard error of the pixel's luminance, m the
  // luminance, M the image's mean luminance. NaN where there are fewer than two samples a pixel.
  double noise() const;

 private:
  struct Pixel {
    uint32_t count = 0, blocks = 0;
    glm::dvec4 mean{0};
    glm::vec4 scatter{0};       // sum over samples of squared deviation from their block's mean
    glm::vec4 blockScatter{0};  // sum over blocks of count x squared deviation from the mean

    // As if all samples were independent.
    glm::dvec4 sampleVariance() const {
      return glm::dvec4(scatter + blockScatter) / double(count - 1);
    }
  };
  const Pixel& pixel(int x, int y) const { return pixels_[size_t(y) * width_ + x]; }

  // Squared standard errors of red, green, blue and luminance, for every pixel.
  std::vector<glm::dvec4> squaredErrors() const;

  int width_, height_;
  std::vector<Pixel> pixels_;
};

}  // namespace chromeball
