// SPDX-License-Identifier: Apache-2.0
// Per-pixel accumulation of the additional layers of an integrator's samples.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace chromeball {

enum class Accumulation { Sum, Maximum };

// One RGB value per pixel and layer. In double: a float sum stops growing after some million
// samples.
class LayerFilm {
 public:
  LayerFilm(int width, int height, std::vector<Accumulation> layers);

  int width() const { return width_; }
  int height() const { return height_; }
  bool empty() const { return layers_.empty(); }

  // Adds one sample: one value per layer. Thread-safe for different pixels.
  void add(int x, int y, std::span<const Rgb> sample);
  // Adds the values of another film of the same size and layers, all of them sums; leaves the
  // counts unchanged.
  void addValues(const LayerFilm& other);

  uint32_t count(int x, int y) const { return counts_[pixel(x, y)]; }  // samples
  const glm::dvec3& value(int x, int y, int layer) const {
    return values_[pixel(x, y) * layers_.size() + size_t(layer)];
  }
  static size_t bytesPerPixel(size_t layers) {
    return layers * sizeof(glm::dvec3) + sizeof(uint32_t);
  }

 private:
  size_t pixel(int x, int y) const { return size_t(y) * size_t(width_) + size_t(x); }

  int width_, height_;
  std::vector<Accumulation> layers_;
  std::vector<uint32_t> counts_;
  std::vector<glm::dvec3> values_;  // [pixel][layer]
};

}  // namespace chromeball
