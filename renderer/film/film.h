// SPDX-License-Identifier: Apache-2.0
// Accumulates samples: the mean of each pixel and an estimate of its error.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/archive.h"
#include "film/noise.h"
#include "film/rows.h"
#include "image/image.h"
#include "math/vec.h"

namespace chromeball {

// Sums over the samples of a pixel. In double, so that sums of a million samples of radiance
// between 1e-8 and 1e10 neither stop growing nor overflow.
struct SampleSums {
  uint32_t count = 0;
  glm::dvec3 sum{0};
  glm::dvec4 sumOfSquares{0};  // of red, green, blue and luminance

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
// The samples of a pixel are split into two halves, each a quasi-random sequence with its own
// randomisation. The halves are independent for any number of samples, so the squared difference of
// their means gives an unbiased estimate of the pixel's variance. The sample variance alone would
// overestimate it, because quasi-random samples are not independent.
class Film {
 public:
  static constexpr int kHalves = 2;

  Film(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }

  // Thread-safe for different pixels.
  void add(int x, int y, int half, const SampleSums& samples);
  // Sets the weight of all samples so far, which is 1 at first; at most once.
  void weigh(double weight);
  // Adds the samples of another film, whose first pixel is this one's pixel (x, y), and which must
  // lie within this one.
  void add(const Film& part, int x, int y);
  // Whether weigh() was called for this film or for one that was added. Call beWeighed() for both
  // films before several threads add or read parts of them.
  bool isWeighed() const { return !early_.empty(); }
  void beWeighed() { early_.resize(pixels_.size()); }
  // Takes these pixels from a film of the same size, weighed like this one.
  void copyPixels(const Film& from, const PixelRect& rect);
  Film part(const PixelRect& rect) const;
  void archive(Archive& a, Rows rows);

  Image mean() const;            // RGB radiance
  Image halfDifference() const;  // half the difference of the means of the halves
  Image sampleCounts() const;    // one channel
  double meanSampleCount() const;
  static size_t bytesPerPixel() { return sizeof(Pixel) + sizeof(Early); }  // at most

  PixelErrors errors() const;
  Noise noise() const { return estimateNoise(errors()); }

 private:
  struct Pixel {
    std::array<uint32_t, kHalves> counts{};
    std::array<double, kHalves> weights{};  // sum over the samples
    std::array<glm::dvec3, kHalves> sums{};
    glm::dvec4 sumOfSquares{0};  // since weigh()

    void add(const Pixel& other);
    uint32_t count() const { return counts[0] + counts[1]; }
    double weight() const { return weights[0] + weights[1]; }
    glm::dvec3 mean() const;
  };

  // The samples of a pixel before weigh().
  struct Early {
    uint64_t count = 0;
    glm::dvec3 sum{0};                // weighted
    glm::dvec4 squaredDeviations{0};  // sum over the samples of (weight (x - mean))^2
  };
  glm::dvec4 scatter(size_t pixel) const;

  int width_, height_;
  std::vector<Pixel> pixels_;
  std::vector<Early> early_;  // empty before weigh()
};

// An image from two independent halves of each pixel's samples (Film).

// The mean of all samples, and half the difference of the means of the two halves. The square of
// the latter is an unbiased estimate of the squared error of `mean`, if both halves have as many
// samples.
struct HalvedImage {
  Image mean, half;
};

HalvedImage operator-(HalvedImage a, const HalvedImage& b);

// Samples that are NaN, infinite or negative. They are counted and excluded from all means.

enum class Defect { Nan, Infinite, Negative };

// The defect of a sample, tested in the order of the enum; nullopt if it is valid. `isSigned`:
// negative values are valid.
inline std::optional<Defect> defectOf(const Rgb& radiance, bool isSigned) {
  const auto any = [&](auto holds) {
    return holds(radiance.x) || holds(radiance.y) || holds(radiance.z);
  };
  if (any([](float x) { return std::isnan(x); })) return Defect::Nan;
  if (any([](float x) { return std::isinf(x); })) return Defect::Infinite;
  if (!isSigned && any([](float x) { return x < 0; })) return Defect::Negative;
  return std::nullopt;
}

struct InvalidSamples {
  std::array<uint64_t, 3> counts{};  // by Defect
  int x = -1, y = -1;                // the first affected pixel in scanline order

  uint64_t of(Defect defect) const { return counts[size_t(defect)]; }
  uint64_t total() const { return counts[0] + counts[1] + counts[2]; }

  void add(Defect defect, int atX, int atY) {
    InvalidSamples one;
    one.counts[size_t(defect)] = 1;
    one.x = atX, one.y = atY;
    add(one);
  }
  void add(const InvalidSamples& other) {
    if (other.total() == 0) return;
    const bool isFirst = total() == 0 || other.y < y || (other.y == y && other.x < x);
    if (isFirst) x = other.x, y = other.y;
    for (size_t i = 0; i < counts.size(); ++i) counts[i] += other.counts[i];
  }
};

}  // namespace chromeball
