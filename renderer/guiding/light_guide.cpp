// SPDX-License-Identifier: Apache-2.0
#include "guiding/light_guide.h"

#include <algorithm>
#include <array>

#include "base/parallel.h"
#include "math/warp.h"

namespace chromeball {
namespace {

constexpr int kMaxDepth = 10;              // 2^-20 of the sphere, less than the Sun's disc
constexpr double kLargestFraction = 0.01;  // of the whole weight, in a square that is not divided
constexpr size_t kMinPoints = 24;          // in a square that is divided
// The share of a square's weight that is spread evenly over its quarters: few points do not prove
// that a direction is dark.
constexpr double kSpread = 0.03;
constexpr size_t kMaxNodes = 4096;  // keeps indices in 16 bits

// Chooses one of two intervals, with probabilities p and 1 - p; u becomes uniform in it. Multiplies
// the density by the interval's density relative to equal probabilities.
int choose(float p, float& u, float& density) {
  const int side = u >= p;
  const float s = float(side);  // without branches, which could not be predicted
  const float probability = s + (1 - 2 * s) * p;
  u = std::min((u - s * p) / probability, 0x1.fffffep-1f);
  density *= 2 * probability;
  return side;
}

// The half of [0, 1) that contains x; x becomes the position in it.
int halve(float& x) {
  const int side = x >= 0.5f;
  x = 2 * x - float(side);
  return side;
}

// The four quarters of a square, whose points become contiguous.
template <class Points>
std::array<Points, 4> quarter(const Points& points, const vec2& middle) {
  const auto divided = [](const Points& all, auto&& isFirst) {
    const auto second = std::partition(all.begin(), all.end(), isFirst);
    return std::array{Points(all.begin(), second), Points(second, all.end())};
  };
  std::array<Points, 4> quarters;
  const auto rows = divided(points, [&](const auto& p) { return p.position.y < middle.y; });
  for (size_t y = 0; y < 2; ++y) {
    const auto halves = divided(rows[y], [&](const auto& p) { return p.position.x < middle.x; });
    quarters[2 * y] = halves[0];
    quarters[2 * y + 1] = halves[1];
  }
  return quarters;
}

double weightOf(std::span<const DirectionTree::Point> points) {
  double sum = 0;
  for (const auto& p : points) sum += p.weight;
  return sum;
}

}  // namespace

DirectionTree::DirectionTree(std::span<Point> points) {
  const double total = weightOf(points);
  if (total > 0) divide(points, {vec2(0), 1}, 0, total);
}

// Sets the last node, and appends its descendants.
void DirectionTree::divide(std::span<Point> points, const Square& square, int depth, double total) {
  const size_t index = nodes_.size() - 1;
  const float half = square.size / 2;
  const auto quarters = quarter(points, square.corner + half);
  std::array<double, 4> found, weights;
  std::transform(quarters.begin(), quarters.end(), found.begin(), weightOf);
  const double spread = kSpread / 4 * (found[0] + found[1] + found[2] + found[3]);
  for (size_t i = 0; i < 4; ++i) weights[i] = found[i] + spread;
  const double left = weights[0] + weights[2], right = weights[1] + weights[3];
  nodes_[index].left = float(left / (left + right));
  nodes_[index].lower = {float(weights[0] / left), float(weights[1] / right)};
  if (depth + 1 == kMaxDepth) return;
  for (size_t i = 0; i < 4; ++i) {
    if (quarters[i].size() < kMinPoints || found[i] < kLargestFraction * total ||
        nodes_.size() == kMaxNodes)
      continue;
    nodes_[index].children[i] = uint16_t(nodes_.size());
    nodes_.emplace_back();
    divide(quarters[i], {square.corner + half * vec2(float(i & 1), float(i >> 1)), half}, depth + 1,
           total);
  }
}

DirectionTree::Sample DirectionTree::sample(vec2 u) const {
  vec2 corner(0);
  float size = 1, density = squareToUniformSpherePdf();
  for (uint16_t child = 0;;) {
    const Node& node = nodes_[child];
    const int x = choose(node.left, u.x, density);
    const int y = choose(node.lower[size_t(x)], u.y, density);
    size /= 2;
    corner += size * vec2(float(x), float(y));
    child = node.children[size_t(x + 2 * y)];
    if (child == 0) return {squareToUniformSphere(corner + size * u), density};
  }
}

float DirectionTree::pdf(const vec3& direction) const {
  vec2 p = uniformSphereToSquare(direction);
  float density = squareToUniformSpherePdf();
  for (uint16_t child = 0;;) {
    const Node& node = nodes_[child];
    const size_t x = size_t(halve(p.x)), y = size_t(halve(p.y));
    density *= 4 * (x ? 1 - node.left : node.left) * (y ? 1 - node.lower[x] : node.lower[x]);
    child = node.children[x + 2 * y];
    if (child == 0) return density;
  }
}

namespace {

constexpr size_t kMinRecords = 1000;  // of a region that is the half of another
constexpr size_t kMinToGuide = 100;   // with fewer, light that none found becomes fireflies
constexpr std::array kFractions = {1.0f, 0.5f, 0.25f, 0.1f, 0.02f};  // of the strategy's samples
// A guided light sample takes up to twice the time.
constexpr double kMaxMomentRatio = 0.7;

using Records = std::span<const LightRecord>;

// The tree of every `step`-th record, beginning with the first.
DirectionTree treeOf(Records records, size_t step) {
  std::vector<DirectionTree::Point> points;
  points.reserve(records.size() / step + 1);
  for (size_t i = 0; i < records.size(); i += step)
    points.push_back(
        {uniformSphereToSquare(records[i].direction), records[i].integrand / records[i].density});
  return DirectionTree(points);
}

// Adds, for each fraction, the part of every second record in the second moment of
//   f cos L / (pdf of light samples + pdf of BSDF samples).
void addMoments(Records records, const DirectionTree& tree,
                std::array<double, kFractions.size()>& moments) {
  for (size_t k = 0; k < records.size(); k += 2) {
    const LightRecord& r = records[k];
    const float treePdf = tree.pdf(r.direction);
    const double squared = double(r.integrand) * r.integrand / r.density;
    for (size_t i = 0; i < kFractions.size(); ++i)
      moments[i] +=
          squared / (kFractions[i] * r.strategyPdf + (1 - kFractions[i]) * treePdf + r.bsdfPdf);
  }
}

}  // namespace

// Each half of the records judges the tree of the other half: on the records that it was made from,
// a tree seems better than it is.
GuideRegion::GuideRegion(std::span<const LightRecord> records) {
  if (records.size() < kMinToGuide) return;
  std::array<double, kFractions.size()> moments{};
  addMoments(records, treeOf(records.subspan(1), 2), moments);
  addMoments(records.subspan(1), treeOf(records, 2), moments);
  const size_t best = size_t(std::min_element(moments.begin(), moments.end()) - moments.begin());
  moments_ = {moments[0], moments[0]};
  if (!(moments[best] < kMaxMomentRatio * moments[0])) return;
  moments_.with = moments[best];
  strategyFraction_ = kFractions[best];
  tree_ = treeOf(records, 1);
}

void LightGuide::learn(std::vector<LightRecord> records) {
  std::vector<std::span<LightRecord>> regions;
  tree_ = RegionTree(std::span(records), kMinRecords, regions);
  regions_.assign(regions.size(), {});
  parallelFor(size_t(0), regions.size(), [&](size_t i) { regions_[i] = GuideRegion(regions[i]); });
}

size_t LightGuide::guidedRegions() const {
  return size_t(std::count_if(regions_.begin(), regions_.end(),
                              [](const GuideRegion& r) { return r.isGuided(); }));
}

GuideRegion::Moments LightGuide::moments() const {
  GuideRegion::Moments sum;
  for (const GuideRegion& r : regions_) {
    sum.without += r.moments().without;
    sum.with += r.moments().with;
  }
  return sum;
}

}  // namespace chromeball
