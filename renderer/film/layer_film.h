// SPDX-License-Identifier: Apache-2.0
// Per-pixel accumulation of the additional layers of an integrator's samples.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "film/aov.h"
#include "film/film.h"
#include "math/vec.h"

namespace chromeball {

enum class Accumulation { Sum, Maximum };

// One RGB value per pixel and layer, for all samples or for each half of them (Film). In double
// precision: a float sum stops growing after some million samples.
class LayerFilm {
 public:
  LayerFilm(int width, int height, std::vector<Accumulation> layers, bool inHalves = false);

  int width() const { return width_; }
  int height() const { return height_; }
  bool empty() const { return layers_.empty(); }

  // Adds one sample: one value per layer. Thread-safe for different pixels.
  void add(int x, int y, int half, std::span<const Rgb> sample);
  // Adds the means of another film of the same size and layers, all of them sums: its values are
  // scaled to this film's counts, which stay. A pixel without samples in one of the two films has
  // none afterwards.
  void addMeans(const LayerFilm& other);

  // The same as Film::add(), part() and archive(). Both films have the same layers.
  void add(const LayerFilm& part, int x, int y);
  void copyPixels(const LayerFilm& from, const PixelRect& rect);
  LayerFilm part(const PixelRect& rect) const;
  void archive(Archive& a, Rows rows);

  uint32_t count(int x, int y) const;  // samples
  glm::dvec3 value(int x, int y, int layer) const;
  HalvedImage mean(int layer) const;  // of a layer of sums; the film must be in halves
  // The film without halves; layers in `means` are replaced by these means.
  LayerFilm with(const std::map<int, Image>& means) const;

  static size_t bytesPerPixel(size_t layers, bool inHalves) {
    return (inHalves ? Film::kHalves : 1) * (layers * sizeof(glm::dvec3) + sizeof(uint32_t));
  }

 private:
  size_t at(int x, int y, int half) const {
    return (size_t(y) * size_t(width_) + size_t(x)) * size_t(halves_) + size_t(half);
  }
  glm::dvec3 joined(size_t layer, const glm::dvec3& a, const glm::dvec3& b) const {
    return layers_[layer] == Accumulation::Sum ? a + b : glm::max(a, b);
  }
  const glm::dvec3& sum(int x, int y, int half, int layer) const {
    return values_[at(x, y, half) * layers_.size() + size_t(layer)];
  }

  int width_, height_, halves_;
  std::vector<Accumulation> layers_;
  std::vector<uint32_t> counts_;    // [pixel][half]
  std::vector<glm::dvec3> values_;  // [pixel][half][layer]
};

// The input of a denoiser besides the image: direct light and the first surface, with
// FirstHit::seen as its albedo, as the means of the two halves of each pixel's samples (Film).

class FeatureFilm {
 public:
  // An unwanted film has no pixels and ignores weigh().
  FeatureFilm(int width, int height, bool wanted);

  bool empty() const { return pixels_.empty(); }

  // Adds a sample whose radiance is `radiance`. Thread-safe for different pixels.
  void add(int x, int y, int half, const FirstHit& first, const Rgb& radiance);
  // The same as Film::weigh().
  void weigh(double weight);
  // The same as Film::add(), part() and archive().
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
