// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "image/image.h"
#include "math/cdf.h"
#include "math/dense_solvers.h"
#include "probe/capture/stitch.h"

namespace chromeball {
namespace {

using glm::dquat;
using glm::dvec3;

constexpr int kCoarsestRows = 64, kFinestRows = 512;  // of images
constexpr float kFloor = 0.05f;

// The median of luminance over all tiles; 1 if that is black.
float medianLuminance(const std::vector<Tile>& tiles) {
  std::vector<float> all;
  for (const Tile& tile : tiles)
    for (int y = 0; y < tile.image.height; ++y)
      for (int x = 0; x < tile.image.width; ++x) all.push_back(luminance(tile.image.rgb(x, y)));
  const float middle = median(std::move(all));
  return middle > 0 ? middle : 1;
}

// The tiles with at most `rows` rows, and log(gain x radiance / unit + 1/20) for radiance.
std::vector<Tile> logTiles(const std::vector<Tile>& tiles, const std::vector<double>& gains,
                           float unit, int rows) {
  std::vector<Tile> logs = tiles;
  for (size_t i = 0; i < tiles.size(); ++i) {
    Image& image = logs[i].image;
    if (image.height > rows)
      image = resampled(
          image, std::max(1, int(std::lround(double(image.width) * rows / image.height))), rows);
    const float factor = float(gains[i]) / unit;
    for (float& channel : image.texels)
      channel = std::log(factor * std::max(channel, 0.0f) + kFloor);
  }
  return logs;
}

// The difference of two tiles in a direction, and its derivatives with respect to turns of the
// first about X, Y, Z and to the logarithm of its gain; the derivatives for the second have the
// opposite sign.
struct Difference {
  dvec3 channels{0};
  std::array<dvec3, 3> byTurn{};
  dvec3 byGain{0};
};

// A turn of the tile by w moves the radiance at d - w x d to d. nullopt next to the tile's edge,
// beyond which it shows nothing.
std::optional<std::array<dvec3, 3>> derivativesOf(const TileView& view, const dvec3& direction) {
  const double step = 0.5 * view.pixelAngle();
  std::array<dvec3, 3> derivatives;
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 turn(0);
    turn[axis] = step;
    const dvec3 shift = glm::cross(turn, direction);
    const TileView::Seen before = view.at(glm::normalize(direction - shift));
    const TileView::Seen after = view.at(glm::normalize(direction + shift));
    if (before.weight == 0 || after.weight == 0) return std::nullopt;
    derivatives[size_t(axis)] = (dvec3(before.radiance) - dvec3(after.radiance)) / (2 * step);
  }
  return derivatives;
}

// The derivatives are means over both tiles, so that turns of all tiles together change only their
// differences from the first tile: each tile's own derivatives would turn all to where they differ
// less by chance. Next to the edge of a tile they are 0, and take no part in the equations.
std::vector<Difference> differencesAt(const std::vector<TileView>& views,
                                      const std::vector<Overlap>& overlaps) {
  std::vector<Difference> all(overlaps.size());
  parallelFor(size_t(0), overlaps.size(), [&](size_t i) {
    const Overlap& o = overlaps[i];
    const TileView &a = views[size_t(o.first)], &b = views[size_t(o.second)];
    const dvec3 ofFirst(a.at(o.direction).radiance), ofSecond(b.at(o.direction).radiance);
    all[i].channels = ofFirst - ofSecond;
    const auto first = derivativesOf(a, o.direction), second = derivativesOf(b, o.direction);
    if (!first || !second) return;
    for (size_t axis = 0; axis < 3; ++axis)
      all[i].byTurn[axis] = 0.5 * ((*first)[axis] + (*second)[axis]);
    // The derivative of log(k x + floor) with respect to log k.
    all[i].byGain = 1.0 - 0.5 * double(kFloor) * (glm::exp(-ofFirst) + glm::exp(-ofSecond));
  });
  return all;
}

double rms(const std::vector<Overlap>& overlaps, const std::vector<Difference>& differences) {
  double sum = 0, weight = 0;
  for (size_t i = 0; i < overlaps.size(); ++i) {
    const dvec3& d = differences[i].channels;
    sum += double(overlaps[i].weight) * glm::dot(d, d) / 3;
    weight += double(overlaps[i].weight);
  }
  return weight > 0 ? std::sqrt(sum / weight) : 0;
}

struct Step {
  dvec3 turn{0};
  double logGain = 0;
};

// The steps of all tiles; the first tile's step is 0. Solves for turns and gains together: where
// one side of an overlap is brighter, a wrong gain looks like a turn.
std::vector<Step> stepsOf(const std::vector<Tile>& tiles, const std::vector<Overlap>& overlaps,
                          const std::vector<Difference>& differences) {
  LeastSquares equations(4 * (int(tiles.size()) - 1));
  std::vector<LeastSquares::Term> row;
  for (size_t i = 0; i < overlaps.size(); ++i)
    for (int channel = 0; channel < 3; ++channel) {
      row.clear();
      const auto add = [&](int tile, double sign) {
        if (tile == 0) return;
        for (int axis = 0; axis < 3; ++axis)
          row.push_back(
              {4 * (tile - 1) + axis, sign * differences[i].byTurn[size_t(axis)][channel]});
        row.push_back({4 * (tile - 1) + 3, sign * differences[i].byGain[channel]});
      };
      add(overlaps[i].first, 1);
      add(overlaps[i].second, -1);
      equations.add(row, -differences[i].channels[channel], double(overlaps[i].weight));
    }
  const auto solution = equations.solve();
  if (!solution)
    throwInput("{}: the overlaps of the tiles do not determine their poses", tiles[0].name);
  const std::vector<double>& x = *solution;
  std::vector<Step> steps(1);
  for (size_t i = 0; i + 3 < x.size(); i += 4)
    steps.push_back({dvec3(x[i], x[i + 1], x[i + 2]), x[i + 3]});
  return steps;
}

// Multiplies the radiance of an image that holds log(x + floor).
void brighten(Image& logs, double logGain) {
  const float gain = float(std::exp(logGain));
  for (float& channel : logs.texels)
    channel = std::log(std::max(std::exp(channel) - kFloor, 0.0f) * gain + kFloor);
}

constexpr int kMaxDirections = 256;  // rows of the map of directions

std::vector<Overlap> overlapsAt(const std::vector<TileView>& views, int rows) {
  return overlapsOf(views, std::min(rows, kMaxDirections));
}

// The RMS of the differences of tiles with so many rows.
double disagreement(const std::vector<Tile>& tiles, int rows) {
  const std::vector<Tile> logs = logTiles(tiles, tileGains(tiles), medianLuminance(tiles), rows);
  const std::vector<TileView> views(logs.begin(), logs.end());
  const std::vector<Overlap> overlaps = overlapsAt(views, rows);
  return rms(overlaps, differencesAt(views, overlaps));
}

void refineAt(std::vector<Tile>& tiles, int rows) {
  constexpr int kMaxSteps = 12;
  constexpr double kEnough = 0.01;  // of a pixel
  std::vector<Tile> logs = logTiles(tiles, tileGains(tiles), medianLuminance(tiles), rows);
  double largest = 1;
  for (int i = 0; i < kMaxSteps && largest > kEnough; ++i) {
    const std::vector<TileView> views(logs.begin(), logs.end());
    const std::vector<Overlap> overlaps = overlapsAt(views, rows);
    const std::vector<Step> steps = stepsOf(tiles, overlaps, differencesAt(views, overlaps));
    largest = 0;
    for (size_t t = 0; t < tiles.size(); ++t) {
      const dvec3& turn = steps[t].turn;
      const double angle = glm::length(turn);
      largest = std::max(largest, angle / views[t].pixelAngle());
      if (angle > 0)
        tiles[t].pose = logs[t].pose = Rotation::ofQuaternion(glm::angleAxis(angle, turn / angle) *
                                                              tiles[t].pose.quaternion());
      brighten(logs[t].image, steps[t].logGain);
    }
  }
}

}  // namespace

PoseRefinement refinePoses(std::vector<Tile>& tiles) {
  if (tiles.size() < 2) return {std::vector<double>(tiles.size()), 0, 0};  // there is no unknown
  std::vector<dquat> given;
  int rows = 1;
  for (const Tile& tile : tiles) {
    given.push_back(tile.pose.quaternion());
    rows = std::max(rows, tile.image.height);
  }
  PoseRefinement refinement{};
  const int finest = std::min(rows, kFinestRows);
  std::vector<int> levels;
  for (int level = kCoarsestRows; level < finest; level *= 2) levels.push_back(level);
  levels.push_back(finest);
  refinement.before = disagreement(tiles, finest);
  for (const int level : levels) refineAt(tiles, level);
  refinement.after = disagreement(tiles, finest);
  for (size_t i = 0; i < tiles.size(); ++i) {
    const double cosine = std::fabs(glm::dot(given[i], tiles[i].pose.quaternion()));
    refinement.turns.push_back(glm::degrees(2 * std::acos(std::min(cosine, 1.0))));
  }
  return refinement;
}

}  // namespace chromeball
