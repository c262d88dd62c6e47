// SPDX-License-Identifier: Apache-2.0
#include "denoise/regression.h"

#include <cmath>

#include "denoise/planes.h"

namespace chromeball {
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

  // In place: L D L^T.
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

// Eight pixels from (x, y); `index` is that of the first in its tile.
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
