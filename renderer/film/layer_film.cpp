// SPDX-License-Identifier: Apache-2.0
#include "film/layer_film.h"

#include <cassert>

namespace chromeball {

LayerFilm::LayerFilm(int width, int height, std::vector<Accumulation> layers)
    : width_(width), height_(height), layers_(std::move(layers)) {
  if (layers_.empty()) return;
  const size_t pixels = size_t(width) * size_t(height);
  counts_.resize(pixels);
  values_.resize(pixels * layers_.size());
}

void LayerFilm::add(int x, int y, std::span<const Rgb> sample) {
  assert(sample.size() == layers_.size());
  const size_t at = pixel(x, y);
  ++counts_[at];
  for (size_t i = 0; i < layers_.size(); ++i) {
    glm::dvec3& value = values_[at * layers_.size() + i];
    const glm::dvec3 found(sample[i]);
    value = layers_[i] == Accumulation::Sum ? value + found : glm::max(value, found);
  }
}

void LayerFilm::addValues(const LayerFilm& other) {
  assert(values_.size() == other.values_.size());
  for (size_t i = 0; i < values_.size(); ++i) values_[i] += other.values_[i];
}

}  // namespace chromeball
