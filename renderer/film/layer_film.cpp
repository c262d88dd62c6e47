// SPDX-License-Identifier: Apache-2.0
#include "film/layer_film.h"

#include <algorithm>
#include <cassert>

namespace chromeball {

LayerFilm::LayerFilm(int width, int height, std::vector<Accumulation> layers, bool inHalves)
    : width_(width),
      height_(height),
      halves_(inHalves ? Film::kHalves : 1),
      layers_(std::move(layers)) {
  if (layers_.empty()) return;
  counts_.resize(size_t(width) * size_t(height) * size_t(halves_));
  values_.resize(counts_.size() * layers_.size());
}

void LayerFilm::add(int x, int y, int half, std::span<const Rgb> sample) {
  assert(sample.size() == layers_.size());
  const size_t to = at(x, y, std::min(half, halves_ - 1));
  ++counts_[to];
  for (size_t i = 0; i < layers_.size(); ++i) {
    glm::dvec3& value = values_[to * layers_.size() + i];
    value = joined(i, value, glm::dvec3(sample[i]));
  }
}

void LayerFilm::addMeans(const LayerFilm& other) {
  assert(values_.size() == other.values_.size());
  for (size_t i = 0; i < counts_.size(); ++i) {
    const bool isSampled = counts_[i] > 0 && other.counts_[i] > 0;
    const double scale = isSampled ? double(counts_[i]) / other.counts_[i] : 0;
    if (!isSampled) counts_[i] = 0;
    for (size_t layer = i * layers_.size(); layer < (i + 1) * layers_.size(); ++layer)
      values_[layer] = isSampled ? values_[layer] + scale * other.values_[layer] : glm::dvec3(0);
  }
}

void LayerFilm::add(const LayerFilm& part, int left, int top) {
  for (int y = 0; y < part.height_ && !empty(); ++y)
    for (int x = 0; x < part.width_; ++x)
      for (int half = 0; half < halves_; ++half) {
        const size_t from = part.at(x, y, half), to = at(left + x, top + y, half);
        counts_[to] += part.counts_[from];
        for (size_t i = 0; i < layers_.size(); ++i) {
          glm::dvec3& value = values_[to * layers_.size() + i];
          value = joined(i, value, part.values_[from * layers_.size() + i]);
        }
      }
}

LayerFilm LayerFilm::part(const PixelRect& rect) const {
  LayerFilm part(rect.width, rect.height, {});
  part.layers_ = layers_, part.halves_ = halves_;
  part.counts_ = rect.of(counts_, width_, size_t(halves_));
  part.values_ = rect.of(values_, width_, size_t(halves_) * layers_.size());
  return part;
}

void LayerFilm::copyPixels(const LayerFilm& from, const PixelRect& rect) {
  if (empty()) return;
  rect.copy(from.counts_, counts_, width_, size_t(halves_));
  rect.copy(from.values_, values_, width_, size_t(halves_) * layers_.size());
}

void LayerFilm::archive(Archive& a, Rows rows) {
  if (empty()) return;
  const size_t perRow = size_t(width_) * size_t(halves_);
  a.items(rows.of(counts_, perRow));
  a.items(rows.of(values_, perRow * layers_.size()));
}

uint32_t LayerFilm::count(int x, int y) const {
  return counts_[at(x, y, 0)] + (halves_ > 1 ? counts_[at(x, y, 1)] : 0);
}

glm::dvec3 LayerFilm::value(int x, int y, int layer) const {
  const glm::dvec3& first = sum(x, y, 0, layer);
  if (halves_ == 1) return first;
  return joined(size_t(layer), first, sum(x, y, 1, layer));
}

HalvedImage LayerFilm::mean(int layer) const {
  assert(halves_ == Film::kHalves && layers_[size_t(layer)] == Accumulation::Sum);
  HalvedImage result{Image(width_, height_, 3), Image(width_, height_, 3)};
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const double a = counts_[at(x, y, 0)], b = counts_[at(x, y, 1)];
      if (a + b > 0) result.mean.setRgb(x, y, Rgb(value(x, y, layer) / (a + b)));
      if (a > 0 && b > 0)
        result.half.setRgb(x, y, Rgb(sum(x, y, 0, layer) / a - sum(x, y, 1, layer) / b) / 2.0f);
    }
  return result;
}

LayerFilm LayerFilm::with(const std::map<int, Image>& means) const {
  LayerFilm result(width_, height_, layers_);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const size_t to = result.at(x, y, 0);
      result.counts_[to] = count(x, y);
      for (int layer = 0; layer < int(layers_.size()); ++layer) {
        const auto replaced = means.find(layer);
        result.values_[to * layers_.size() + size_t(layer)] =
            replaced == means.end() ? value(x, y, layer)
                                    : glm::dvec3(replaced->second.rgb(x, y)) * double(count(x, y));
      }
    }
  return result;
}

FeatureFilm::FeatureFilm(int width, int height, bool wanted)
    : width_(width), height_(height), pixels_(wanted ? size_t(width) * size_t(height) : 0) {}

void FeatureFilm::add(int x, int y, int half, const FirstHit& first, const Rgb& radiance) {
  const Rgb direct = first.direct ? glm::min(*first.direct, radiance) : radiance;
  const float disparity = first.hit && first.depth > 0 ? 1 / first.depth : 0;
  const std::array<float, kChannels> values{
      direct.x,     direct.y,       direct.z,       first.seen.x,   first.seen.y,
      first.seen.z, first.normal.x, first.normal.y, first.normal.z, disparity};
  Half& to = pixels_[size_t(y) * size_t(width_) + size_t(x)][size_t(half)];
  to.weight += 1;
  for (size_t c = 0; c < kChannels; ++c) to.sums[c] += values[c];
}

void FeatureFilm::weigh(double weight) {
  for (Pixel& pixel : pixels_)
    for (Half& half : pixel) {
      half.weight *= weight;
      for (double& sum : half.sums) sum *= weight;
    }
}

void FeatureFilm::add(const FeatureFilm& part, int left, int top) {
  for (int y = 0; y < part.height_ && !part.empty(); ++y)
    for (int x = 0; x < part.width_; ++x) {
      const Pixel& from = part.pixels_[size_t(y) * size_t(part.width_) + size_t(x)];
      Pixel& to = pixels_[size_t(top + y) * size_t(width_) + size_t(left + x)];
      for (size_t half = 0; half < to.size(); ++half) {
        to[half].weight += from[half].weight;
        for (size_t c = 0; c < kChannels; ++c) to[half].sums[c] += from[half].sums[c];
      }
    }
}

HalvedImage FeatureFilm::channels(size_t first, int count) const {
  HalvedImage result{Image(width_, height_, count), Image(width_, height_, count)};
  for (size_t i = 0; i < pixels_.size(); ++i) {
    const auto& [a, b] = pixels_[i];
    for (size_t c = 0; c < size_t(count); ++c) {
      const double sumA = a.sums[first + c], sumB = b.sums[first + c];
      const size_t at = i * size_t(count) + c;
      if (a.weight + b.weight > 0)
        result.mean.texels[at] = float((sumA + sumB) / (a.weight + b.weight));
      if (a.weight > 0 && b.weight > 0)
        result.half.texels[at] = float((sumA / a.weight - sumB / b.weight) / 2);
    }
  }
  return result;
}

}  // namespace chromeball
