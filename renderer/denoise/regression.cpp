// SPDX-License-Identifier: Apache-2.0
#include "denoise/regression.h"

#include <cassert>
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
// Whole vectors of a tile's pixels and their patches, and windows around them, are read.
static_assert(2 * kPatch + kLanes + TileWeights::kReach <= Plane::kMargin);
using Padded = std::array<std::array<float, kPaddedWidth>, kPaddedHeight>;

// Pixels in vectors that begin with the area's.
constexpr int wholeVectors(int width) { return (width + kLanes - 1) / kLanes * kLanes; }

constexpr float kFarthest = 1e4f;  // a larger distance of one pixel counts as this

void pixelDistances(const NoisyPlanes& guide, const PixelArea& area, int dx, int dy,
                    Padded& distances) {
  constexpr int kVectors = kPaddedWidth / kLanes;
  const float scale = 1 / float(guide.values.size());
  const int vectors = (wholeVectors(area.width) + 2 * kPatch + kLanes - 1) / kLanes;
  for (int y = 0; y < area.height + 2 * kPatch; ++y) {
    const int row = area.top - kPatch + y, column = area.left - kPatch;
    Float8 sums[kVectors]{};
    for (size_t c = 0; c < guide.values.size(); ++c) {
      const float* value = guide.values[c].row(row) + column;
      const float* otherValue = guide.values[c].row(row + dy) + column + dx;
      const float* variance = guide.variances[c].row(row) + column;
      const float* otherVariance = guide.variances[c].row(row + dy) + column + dx;
      for (int i = 0; i < vectors; ++i) {
        const int x = i * kLanes;
        const Float8 difference = load8(value + x) - load8(otherValue + x);
        const Float8 both = load8(variance + x) + load8(otherVariance + x);
        sums[i] += (difference * difference - both) / (both + 1e-30f);
      }
    }
    for (int i = 0; i < vectors; ++i)
      store8(&distances[size_t(y)][size_t(i * kLanes)], min8(sums[i] * scale, splat8(kFarthest)));
  }
}

// The weights of the wanted rows, from the mean over the patch around each pixel.
void weightsOf(const Padded& distances, const PixelArea& area, TileWeights::Rows rows,
               TileWeights::Tile& weights) {
  constexpr int kSide = 2 * kPatch + 1;
  std::array<float, kPaddedWidth> columns{};  // sums
  for (int y = rows.first; y < area.height; y += rows.step) {
    for (int x = 0; x < wholeVectors(area.width) + 2 * kPatch; x += kLanes) {
      Float8 sum{};
      for (int i = 0; i < kSide; ++i) sum += load8(&distances[size_t(y + i)][size_t(x)]);
      store8(&columns[size_t(x)], sum);
    }
    for (int x = 0; x < area.width; x += kLanes) {
      Float8 sum{};
      for (int i = 0; i < kSide; ++i) sum += load8(&columns[size_t(x + i)]);
      const Float8 mean = sum * (1 / float(kSide * kSide));
      store8(&weights[size_t(y * kTileWidth + x)], expOfMinus(max8(mean, Float8{})));
    }
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

void TileWeights::compute(const NoisyPlanes& guide, const PixelArea& area, Rows wanted) {
  assert(area.width <= kTileWidth && area.height <= kTileHeight);
  const Plane& plane = guide.values[0];
  Padded distances;
  forNeighbours([&](size_t neighbour, int dx, int dy) {
    Tile& tile = weights_[neighbour];
    pixelDistances(guide, area, dx, dy, distances);
    weightsOf(distances, area, wanted, tile);
    const Range columns(area.left, kTileWidth, dx, plane.width()),
        rows(area.top, kTileHeight, dy, plane.height());
    for (int y = wanted.first; y < area.height; y += wanted.step) {
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
void addArea(const TileWeights& weights, const RgbPlanes& color, const FeaturePlanes& features,
             const PixelArea& area, TileWeights::Rows rows, Predictions& predictions) {
  for (int y = rows.first; y < area.height; y += rows.step)
    for (int x = 0; x < area.width; x += kLanes)
      addRegression<kPower>(weights, size_t(y * TileWeights::kWidth + x), color, features,
                            area.left + x, area.top + y, predictions);
}

}  // namespace

void addRegressions(const TileWeights& weights, int power, const RgbPlanes& color,
                    const FeaturePlanes& features, const PixelArea& area, TileWeights::Rows rows,
                    Predictions& predictions) {
  const auto add = power == 1 ? addArea<1> : power == 4 ? addArea<4> : addArea<8>;
  add(weights, color, features, area, rows, predictions);
}

}  // namespace chromeball
