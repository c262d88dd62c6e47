// SPDX-License-Identifier: Apache-2.0
// What a denoiser reads besides the image: direct light and the first surface, with FirstHit::seen
// as its albedo, as the means of the two halves of each pixel's samples (Film).
#pragma once

#include <array>
#include <vector>

#include "film/aov.h"
#include "film/film.h"
#include "film/halved_image.h"

namespace chromeball {

class FeatureFilm {
 public:
  // An unwanted film has no pixels and ignores weigh().
  FeatureFilm(int width, int height, bool wanted);

  bool empty() const { return pixels_.empty(); }

  // A sample whose radiance is `radiance`. Thread-safe for different pixels.
  void add(int x, int y, int half, const FirstHit& first, const Rgb& radiance);
  // As Film::weigh().
  void weigh(double weight);
  // As Film::add(), part() and archive().
  void add(const FeatureFilm& part, int x, int y);
  void copyPixels(const FeatureFilm& from, const PixelRect& rect) {
    if (!empty()) rect.copy(from.pixels_, pixels_, width_);
  }
  FeatureFilm part(const PixelRect& rect) const {
    FeatureFilm part(rect.width, rect.height, false);
    part.pixels_ = rect.of(pixels_, width_);
    return part;
  }
  void archive(Archive& a, Rows rows) {
    if (!empty()) a.items(rows.of(pixels_, size_t(width_)));
  }

  HalvedImage direct() const { return channels(0, 3); }
  HalvedImage albedo() const { return channels(3, 3); }
  HalvedImage normal() const { return channels(6, 3); }
  // 1 / depth, 0 without a hit: affine in the pixel's position where the surface is a plane.
  HalvedImage disparity() const { return channels(9, 1); }

  static size_t bytesPerPixel() { return sizeof(Pixel); }
  static constexpr int kLayerChannels = 23;  // of Aov::Denoise: means and halves

 private:
  static constexpr int kChannels = 10;
  struct Half {
    double weight = 0;
    std::array<double, kChannels> sums{};
  };
  using Pixel = std::array<Half, Film::kHalves>;

  HalvedImage channels(size_t first, int count) const;

  int width_, height_;
  std::vector<Pixel> pixels_;
};

}  // namespace chromeball
