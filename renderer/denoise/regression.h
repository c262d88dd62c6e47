// SPDX-License-Identifier: Apache-2.0
// First-order regression of an image on its features in the window around each pixel (Bitterli et
// al. 2016, "Nonlinearly weighted first-order regression for denoising Monte Carlo renderings").
#pragma once

#include "denoise/nl_means.h"

namespace chromeball {

constexpr int kFeatures = 7;  // albedo, normal, disparity

struct FeaturePlanes {
  std::array<Plane, kFeatures> values;
  std::array<Plane, kFeatures> ridges;  // squares of differences that explain nothing
};

// Sums over the windows that contain a pixel, of what their regressions predict for it.
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

// For each pixel p of the tile, fits b to
//   color(q) ~ b0 + sum_i b_i (feature_i(q) - feature_i(p))
// over the window of p, with the weights raised to a power (1, 4 or 8), and adds its predictions
// for all q. Writes at most TileWeights::kReach pixels, and a vector, outside the tile.
void addRegressions(const TileWeights& weights, int power, const RgbPlanes& color,
                    const FeaturePlanes& features, int left, int top, Predictions& predictions);

}  // namespace chromeball
