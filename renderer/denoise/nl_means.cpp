// SPDX-License-Identifier: Apache-2.0
#include "denoise/nl_means.h"

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

}  // namespace chromeball
