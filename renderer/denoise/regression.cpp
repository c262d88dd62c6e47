// SPDX-License-Identifier: Apache-2.0
#include "denoise/regression.h"

#include <cmath>

#include "denoise/planes.h"

namespace chromeball {
namespace {

constexpr int kTileWidth = TileWeights::kWidth, kTileHeight = TileWeights::kHeight;
constexpr int kPatch = TileWeights::kPatch;

// A tile and the patches around its pixels.
constexpr int kPaddedHeight = kTileHeight + 2 * kPatch;
constexpr int kPaddedWidth = kTileWidth + kLanes;
static_assert(2 * kPatch <= kLanes);
static_assert(kPaddedWidth + kPatch + TileWeights::kReach <= Plane::kMargin);
using Padded = std::array<std::array<float, kPaddedWidth>, kPaddedHeight>;

constexpr float kFarthest = 1e4f;  // a larger distance of one pixel counts as this

void pixelDistances(const NoisyPlanes& guide, int left, int top, int dx, int dy,
                    Padded& distances) {
  const float scale = 1 / float(guide.values.size());
  for (int y = 0; y < kPaddedHeight; ++y) {
    const int row = top - kPatch + y, column = left - kPatch;
    for (int x = 0; x < kPaddedWidth; x += kLanes) {
      Float8 sum{};
      for (size_t c = 0; c < guide.values.size(); ++c) {
        const Plane &values = guide.values[c], &variances = guide.variances[c];
        const Float8 difference =
            load8(values.row(row) + column + x) - load8(values.row(row + dy) + column + x + dx);
        const Float8 variance = load8(variances.row(row) + column + x) +
                                load8(variances.row(row + dy) + column + x + dx);
        sum += (difference * difference - variance) / (variance + 1e-30f);
      }
      store8(&distances[size_t(y)][size_t(x)], min8(sum * scale, splat8(kFarthest)));
    }
  }
}

// The mean over the patch around each pixel of the tile. Overwrites `distances`.
void patchMeans(Padded& distances, TileWeights::Tile& means) {
  constexpr int kSide = 2 * kPatch + 1;
  for (auto& row : distances)
    for (int x = 0; x < kTileWidth; x += kLanes) {
      Float8 sum{};
      for (int i = 0; i < kSide; ++i) sum += load8(&row[size_t(x + i)]);
      store8(&row[size_t(x)], sum);
    }
  for (int y = 0; y < kTileHeight; ++y)
    for (int x = 0; x < kTileWidth; x += kLanes) {
      Float8 sum{};
      for (int i = 0; i < kSide; ++i) sum += load8(&distances[size_t(y + i)][size_t(x)]);
      store8(&means[size_t(y * kTileWidth + x)], sum * (1 / float(kSide * kSide)));
    }
}

// Pixels [begin, end) of [first, first + count) that are inside an image of `size`, and whose
// neighbours at `offset` are inside too; relative to `first`.
struct Range {
  int begin, end;
  Range(int first, int count, int offset, int size)
      : begin(std::max(0, -offset - first)),
        end(std::min({count, size - first, size - offset - first})) {}
};

}  // namespace

void TileWeights::compute(const NoisyPlanes& guide, int left, int top) {
  const Plane& plane = guide.values[0];
  Padded distances;
  forNeighbours([&](size_t neighbour, int dx, int dy) {
    Tile& tile = weights_[neighbour];
    pixelDistances(guide, left, top, dx, dy, distances);
    patchMeans(distances, tile);
    for (size_t i = 0; i < tile.size(); i += kLanes)
      store8(&tile[i], expOfMinus(max8(load8(&tile[i]), Float8{})));

    const Range columns(left, kTileWidth, dx, plane.width()),
        rows(top, kTileHeight, dy, plane.height());
    for (int y = 0; y < kTileHeight; ++y) {
      float* row = &tile[size_t(y * kTileWidth)];
      const bool inside = y >= rows.begin && y < rows.end && columns.begin < columns.end;
      std::fill(row, row + (inside ? columns.begin : kTileWidth), 0.0f);
      if (inside) std::fill(row + columns.end, row + kTileWidth, 0.0f);
    }
  });
}

namespace {

constexpr int kTerms = kFeatures + 1;
constexpr float kNegligible = 1e-4f;  // weight

// The weighted least-squares problems of eight pixels: the lower triangle of the normal matrix, and
// one right-hand side per channel.
struct NormalEquations {
  Float8 matrix[kTerms][kTerms]{};
  Float8 right[kTerms][3]{};

  // Replaces `right` by the solution.
  void solve() {
    const auto scale = equilibrate();
    factorize();
    for (int c = 0; c < 3; ++c) {
      for (int i = 0; i < kTerms; ++i)
        for (int k = 0; k < i; ++k) right[i][c] -= matrix[i][k] * right[k][c];
      for (int i = kTerms - 1; i >= 0; --i) {
        right[i][c] /= matrix[i][i];
        for (int k = i + 1; k < kTerms; ++k) right[i][c] -= matrix[k][i] * right[k][c];
      }
      for (int i = 0; i < kTerms; ++i) right[i][c] *= scale[size_t(i)];
    }
  }

 private:
  // Scales the diagonal to 1, so that floats suffice for features of any size.
  std::array<Float8, kTerms> equilibrate() {
    std::array<Float8, kTerms> scale;
    for (int i = 0; i < kTerms; ++i) {
      for (int k = 0; k < kLanes; ++k)
        scale[size_t(i)][k] = 1 / std::sqrt(matrix[i][i][k] + 1e-30f);
      for (int j = 0; j <= i; ++j) matrix[i][j] *= scale[size_t(i)] * scale[size_t(j)];
      for (Float8& r : right[i]) r *= scale[size_t(i)];
    }
    return scale;
  }

  // Factorises into L D L^T, in place.
  void factorize() {
    constexpr float kSmallestPivot = 1e-5f;  // for rounding errors where features depend linearly
    for (int j = 0; j < kTerms; ++j) {
      for (int k = 0; k < j; ++k) matrix[j][j] -= matrix[j][k] * matrix[j][k] * matrix[k][k];
      matrix[j][j] = max8(matrix[j][j], splat8(kSmallestPivot));
      for (int i = j + 1; i < kTerms; ++i) {
        for (int k = 0; k < j; ++k) matrix[i][j] -= matrix[i][k] * matrix[j][k] * matrix[k][k];
        matrix[i][j] /= matrix[j][j];
      }
    }
  }
};

template <int kPower>
Float8 raised(Float8 weight) {
  for (int power = 1; power < kPower; power *= 2) weight *= weight;
  return weight;
}

// Processes eight pixels from (x, y); `index` is the first one's in its tile.
template <int kPower>
void addRegression(const TileWeights& weights, size_t index, const RgbPlanes& color,
                   const FeaturePlanes& features, int x, int y, Predictions& predictions) {
  Float8 centre[kFeatures];
  for (size_t i = 0; i < kFeatures; ++i) centre[i] = load8(features.values[i].row(y) + x);
  const auto forSimilar = [&](const auto& visit) {
    forNeighbours([&](size_t neighbour, int dx, int dy) {
      const Float8 weight = raised<kPower>(load8(&weights[neighbour][index]));
      if (anyAbove(weight, kNegligible)) visit(weight, x + dx, y + dy);
    });
  };

  NormalEquations equations;
  forSimilar([&](Float8 weight, int u, int v) {
    Float8 terms[kTerms], weighted[kTerms];
    terms[0] = splat8(1), weighted[0] = weight;
    for (size_t i = 0; i < kFeatures; ++i) {
      terms[i + 1] = load8(features.values[i].row(v) + u) - centre[i];
      weighted[i + 1] = weight * terms[i + 1];
    }
    for (int i = 0; i < kTerms; ++i)
      for (int j = 0; j <= i; ++j) equations.matrix[i][j] += weighted[i] * terms[j];
    for (size_t c = 0; c < 3; ++c) {
      const Float8 value = load8(color[c].row(v) + u);
      for (int i = 0; i < kTerms; ++i) equations.right[i][c] += weighted[i] * value;
    }
  });
  for (int i = 1; i < kTerms; ++i)
    equations.matrix[i][i] +=
        equations.matrix[0][0] * load8(features.ridges[size_t(i - 1)].row(y) + x);
  equations.solve();

  const auto& b = equations.right;
  Float8 constant[3];
  for (size_t c = 0; c < 3; ++c) {
    constant[c] = b[0][c];
    for (size_t i = 0; i < kFeatures; ++i) constant[c] -= b[i + 1][c] * centre[i];
  }
  forSimilar([&](Float8 weight, int u, int v) {
    Float8 prediction[3] = {constant[0], constant[1], constant[2]};
    for (size_t i = 0; i < kFeatures; ++i) {
      const Float8 feature = load8(features.values[i].row(v) + u);
      for (int c = 0; c < 3; ++c) prediction[c] += b[i + 1][c] * feature;
    }
    const auto add = [&](Plane& to, Float8 x8) {
      store8(to.row(v) + u, load8(to.row(v) + u) + x8);
    };
    for (size_t c = 0; c < 3; ++c) add(predictions.weighted[c], weight * prediction[c]);
    add(predictions.weights, weight);
  });
}

template <int kPower>
void addTile(const TileWeights& weights, const RgbPlanes& color, const FeaturePlanes& features,
             int left, int top, Predictions& predictions) {
  const int columns = std::min(TileWeights::kWidth, color[0].width() - left);
  const int rows = std::min(TileWeights::kHeight, color[0].height() - top);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; x += kLanes)
      addRegression<kPower>(weights, size_t(y * TileWeights::kWidth + x), color, features, left + x,
                            top + y, predictions);
}

}  // namespace

void addRegressions(const TileWeights& weights, int power, const RgbPlanes& color,
                    const FeaturePlanes& features, int left, int top, Predictions& predictions) {
  const auto add = power == 1 ? addTile<1> : power == 4 ? addTile<4> : addTile<8>;
  add(weights, color, features, left, top, predictions);
}

}  // namespace chromeball
