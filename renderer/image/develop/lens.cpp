// SPDX-License-Identifier: Apache-2.0
#include "image/develop/lens.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace chromeball {
namespace {

constexpr int kTile = 16;

struct Disc {
  float radius, area, depth;
};

// A disc of this radius covers the pixel in its middle and no other.
constexpr float kSharp = 0.5f;

// The integral of clamp(radius + 1/2 - distance, 0, 1) over the plane; 1 for the single pixel.
float areaOf(float radius) {
  return radius <= kSharp ? 1 : float(kPiD) * (radius * radius + 1.0f / 12);
}

std::vector<Disc> discsOf(const Image& depth, const ThinLens& lens, const ViewFrame& frame) {
  std::vector<Disc> discs(depth.texels.size());
  forRanges(discs.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const float radius = std::max(kSharp, float(confusionRadius(lens, depth.texels[i], frame)));
      discs[i] = {radius, areaOf(radius), depth.texels[i]};
    }
  });
  return discs;
}

// The distance from each tile within which discs may cover one of its pixels.
class Reach {
 public:
  Reach(const std::vector<Disc>& discs, int width, int height)
      : columns_((width - 1) / kTile + 1), rows_((height - 1) / kTile + 1) {
    std::vector<float> largest(size_t(columns_) * rows_, 0.0f);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        float& tile = largest[index(x / kTile, y / kTile)];
        tile = std::max(tile, discs[size_t(y) * width + x].radius);
      }
    reach_ = largest;
    for (int y = 0; y < rows_; ++y)
      for (int x = 0; x < columns_; ++x) reach_[index(x, y)] = around(largest, x, y);
  }

  int at(int x, int y) const { return int(std::ceil(reach_[index(x / kTile, y / kTile)])); }

 private:
  size_t index(int x, int y) const { return size_t(y) * columns_ + x; }

  // The largest radius of the tiles that are near enough for it.
  float around(const std::vector<float>& largest, int tileX, int tileY) const {
    constexpr int kFar = int(kMaxConfusionRadius) / kTile + 1;
    float reach = 0;
    for (int y = std::max(0, tileY - kFar); y <= std::min(rows_ - 1, tileY + kFar); ++y)
      for (int x = std::max(0, tileX - kFar); x <= std::min(columns_ - 1, tileX + kFar); ++x) {
        const float radius = largest[index(x, y)];
        const int gap = std::max({std::abs(x - tileX) - 1, std::abs(y - tileY) - 1, 0}) * kTile;
        if (radius + 1 >= float(gap)) reach = std::max(reach, radius);
      }
    return reach;
  }

  int columns_, rows_;
  std::vector<float> reach_;
};

// The share of the pixel `own` that the disc of `other`, `distance` pixels away, covers, over the
// area of that disc.
float weightOf(const Disc& own, const Disc& other, float distance) {
  const bool isBehind = other.depth > own.depth && own.radius < other.radius;
  const float radius = isBehind ? own.radius : other.radius;
  const float cover = std::min(1.0f, radius + 0.5f - distance);
  return cover <= 0 ? 0 : cover / (isBehind ? own.area : other.area);
}

void gather(const Image& image, const std::vector<Disc>& discs, int x, int y, int reach,
            float* result) {
  const Disc& own = discs[size_t(y) * image.width + x];
  const int channels = image.channels;
  double sum[4] = {}, weights = 0;
  for (int j = std::max(0, y - reach); j <= std::min(image.height - 1, y + reach); ++j)
    for (int i = std::max(0, x - reach); i <= std::min(image.width - 1, x + reach); ++i) {
      const int squared = (i - x) * (i - x) + (j - y) * (j - y);
      const Disc& other = discs[size_t(j) * image.width + i];
      const float weight = weightOf(own, other, std::sqrt(float(squared)));
      if (weight == 0) continue;
      weights += double(weight);
      for (int c = 0; c < channels; ++c) sum[c] += double(weight) * double(image.at(i, j)[c]);
    }
  for (int c = 0; c < channels; ++c) result[c] = float(sum[c] / weights);
}

struct Between {
  int first, second;
  float t;
};

// The position of pixel i of `count` among n texels.
Between position(int i, int count, int n) {
  const double u = std::clamp((i + 0.5) * n / count - 0.5, 0.0, double(n - 1));
  const int first = int(u);
  return {first, std::min(first + 1, n - 1), float(u - first)};
}

// The first three channels, or one for all.
Rgb texel(const Image& image, int x, int y) {
  return image.channels >= 3 ? image.rgb(x, y) : Rgb(*image.at(x, y));
}

}  // namespace

void vignette(Image& image, double strength, const ViewFrame& frame) {
  const double size = frame.pixelSize();
  forRows(image.width, image.height, [&](int y) {
    for (int x = 0; x < image.width; ++x) {
      const double across = size * (frame.x + x + 0.5 - 0.5 * frame.width);
      const double up = size * (frame.y + y + 0.5 - 0.5 * frame.height);
      const double cos2 = 1 / (1 + across * across + up * up);
      image.setRgb(x, y, image.rgb(x, y) * float(1 - strength * (1 - cos2 * cos2)));
    }
  });
}

void multiplyFalloff(Image& image, const Image& falloff, const ViewFrame& frame) {
  forRows(image.width, image.height, [&](int y) {
    const Between v = position(frame.y + y, frame.height, falloff.height);
    for (int x = 0; x < image.width; ++x) {
      const Between u = position(frame.x + x, frame.width, falloff.width);
      const auto row = [&](int j) {
        return glm::mix(texel(falloff, u.first, j), texel(falloff, u.second, j), u.t);
      };
      image.setRgb(x, y, image.rgb(x, y) * glm::mix(row(v.first), row(v.second), v.t));
    }
  });
}

double confusionRadius(const ThinLens& lens, double depth, const ViewFrame& frame) {
  if (!(depth > 0)) return 0;
  const double atFocus = lens.aperture / 2 * std::fabs(1 - lens.focus / depth);
  return std::min(kMaxConfusionRadius, atFocus / (lens.focus * frame.pixelSize()));
}

Image blurByDepth(const Image& image, const Image& depth, const ThinLens& lens,
                  const ViewFrame& frame) {
  const std::vector<Disc> discs = discsOf(depth, lens, frame);
  const Reach reach(discs, image.width, image.height);
  Image blurred(image.width, image.height, image.channels);
  forRows(image.width, image.height, 256, [&](int y) {
    for (int x = 0; x < image.width; ++x)
      gather(image, discs, x, y, reach.at(x, y), blurred.at(x, y));
  });
  return blurred;
}

}  // namespace chromeball
