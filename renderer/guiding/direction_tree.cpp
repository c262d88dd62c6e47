// SPDX-License-Identifier: Apache-2.0
#include "guiding/direction_tree.h"

#include <algorithm>

#include "math/warp.h"

namespace chromeball {
namespace {

constexpr int kMaxDepth = 10;              // 2^-20 of the sphere, less than the Sun's disc
constexpr double kLargestFraction = 0.01;  // of the whole weight, in a square that is not divided
constexpr size_t kMinPoints = 24;          // in a square that is divided
// Of a square's weight, spread evenly over its quarters: few points do not prove that a direction
// is dark.
constexpr double kSpread = 0.03;
constexpr size_t kMaxNodes = 4096;  // keeps indices in 16 bits

// Chooses one of two intervals, with probabilities p and 1 - p; u becomes uniform in it. Multiplies
// the density by that of the interval relative to equal probabilities.
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

}  // namespace chromeball
