// SPDX-License-Identifier: Apache-2.0
#include "film/feature_film.h"

namespace chromeball {

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
