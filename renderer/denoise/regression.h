// SPDX-License-Identifier: Apache-2.0
// First-order regression of an image on its features in the window around each pixel (Bitterli et
// al. 2016, "Nonlinearly weighted first-order regression for denoising Monte Carlo renderings").
#pragma once

#include <array>
#include <vector>

#include "denoise/planes.h"

namespace chromeball {

// Similarity of pixels by the patches around them (non-local means; Buades, Coll, Morel 2005), with
// the noise of each pixel taken into account (Rousselle, Knaus, Zwicker 2012, section 3).

// Channels, and the variances of their errors.
struct NoisyPlanes {
  std::vector<Plane> values, variances;
};

// Pixels of an image.
struct PixelArea {
  int left, top, width, height;

  bool empty() const { return width <= 0 || height <= 0; }
  int right() const { return left + width; }
  int bottom() const { return top + height; }
};

// For each pixel p of an area of at most a tile: the weights of the pixels of the window around p.
// The area consists of whole vectors of kLanes pixels, but for those that the image's edge cuts.
class TileWeights {
 public:
  static constexpr int kWidth = 32, kHeight = 32;
  static constexpr int kReach = 7;  // of windows: 15 x 15 pixels
  static constexpr int kPatch = 3;  // of patches: 7 x 7 pixels
  static constexpr int kOffsets = (2 * kReach + 1) * (2 * kReach + 1);

  using Tile = std::array<float, size_t(kWidth) * kHeight>;

  TileWeights() : weights_(kOffsets) {}

  // Rows of an area: all, or every second one from `first` on.
  struct Rows {
    int first = 0, step = 1;
  };

  // exp(-max(d, 0)), where d is the mean over patch and channels of
  //   ((a - b)^2 - (var a + var b)) / (var a + var b);
  // 0 for p or its neighbour outside the image. Only for p in `rows` of the area.
  void compute(const NoisyPlanes& guide, const PixelArea& area, Rows rows);

  // The weights of neighbour (dx, dy), for all p, in rows of kWidth from the first pixel of the
  // area on; neighbours are ordered by rows.
  const Tile& operator[](size_t neighbour) const { return weights_[neighbour]; }

 private:
  std::vector<Tile> weights_;
};

// Calls visit(neighbour, dx, dy) for the window of a pixel, in the order of TileWeights.
template <class Visit>
void forNeighbours(const Visit& visit) {
  size_t neighbour = 0;
  for (int dy = -TileWeights::kReach; dy <= TileWeights::kReach; ++dy)
    for (int dx = -TileWeights::kReach; dx <= TileWeights::kReach; ++dx) visit(neighbour++, dx, dy);
}

constexpr int kFeatures = 7;  // albedo, normal, disparity

struct FeaturePlanes {
  std::array<Plane, kFeatures> values;
  std::array<Plane, kFeatures> ridges;  // squares of differences that explain nothing
};

// For each pixel, the sum of the predictions by the regressions of all windows that contain it.
struct Predictions {
  RgbPlanes weighted;  // weight x prediction
  Plane weights;

  Predictions(int width, int height)
      : weighted{Plane(width, height), Plane(width, height), Plane(width, height)},
        weights(width, height) {
    for (Plane& plane : weighted) plane.clear();
    weights.clear();
  }
};

// For each pixel p in `rows` of the area of the weights, fits b to
//   color(q) ~ b0 + sum_i b_i (feature_i(q) - feature_i(p))
// over the window of p, with the weights raised to a power (1, 4 or 8), and adds its predictions
// for all q. Writes at most TileWeights::kReach pixels, and a vector, outside the area.
void addRegressions(const TileWeights& weights, int power, const RgbPlanes& color,
                    const FeaturePlanes& features, const PixelArea& area, TileWeights::Rows rows,
                    Predictions& predictions);

}  // namespace chromeball
