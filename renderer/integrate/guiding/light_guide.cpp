// SPDX-License-Identifier: Apache-2.0
#include "integrate/guiding/light_guide.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

#include "math/warp.h"

namespace chromeball {
namespace {

constexpr uint32_t kSides = 6, kLeaf = 3;
constexpr size_t kMinRecords = 1000;  // of a region that is the half of another
constexpr size_t kMinToGuide = 100;   // fewer leave light that none of them found to fireflies
constexpr std::array kFractions = {1.0f, 0.5f, 0.25f, 0.1f, 0.02f};  // of the strategy's samples
// A guided light sample takes up to twice the time.
constexpr double kMaxMomentRatio = 0.7;

// Which of six axes is nearest to the normal.
uint32_t sideOf(const vec3& n) {
  const vec3 a = absolute(n);
  const uint32_t axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  return 2 * axis + (n[int(axis)] < 0);
}

using Records = std::span<const LightRecord>;

// Of every `step`-th record, beginning with the first.
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

// Each half of the records judges the tree of the other half: a tree seems better than it is on
// the records that it was made of.
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

const GuideRegion* LightGuide::regionAt(const vec3& position, const vec3& normal) const {
  const Node* node = &nodes_[sideOf(normal)];
  while (node->axis != kLeaf)
    node = &nodes_[node->index + (position[int(node->axis)] >= node->split)];
  const GuideRegion& region = regions_[node->index];
  return region.isGuided() ? &region : nullptr;
}

// Divides at the median along the longest axis.
void LightGuide::divide(size_t node, Records records, std::vector<Records>& leaves) {
  vec3 low(INFINITY), high(-INFINITY);
  for (const LightRecord& r : records) {
    low = glm::min(low, r.position);
    high = glm::max(high, r.position);
  }
  const vec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  auto right = records.begin();
  float split = 0;
  if (records.size() >= 2 * kMinRecords) {
    const auto middle = records.begin() + std::ptrdiff_t(records.size() / 2);
    std::nth_element(records.begin(), middle, records.end(), [&](const auto& a, const auto& b) {
      return a.position[axis] < b.position[axis];
    });
    split = middle->position[axis];
    right = std::partition(records.begin(), records.end(),
                           [&](const auto& r) { return r.position[axis] < split; });
  }
  if (right == records.begin()) {  // too few, or half of them have the smallest coordinate
    nodes_[node] = {0, kLeaf, uint32_t(leaves.size())};
    leaves.push_back(records);
    return;
  }
  const size_t child = nodes_.size();
  nodes_[node] = {split, uint32_t(axis), uint32_t(child)};
  nodes_.resize(child + 2);
  divide(child, {records.begin(), right}, leaves);
  divide(child + 1, {right, records.end()}, leaves);
}

void LightGuide::learn(std::vector<LightRecord> records) {
  nodes_.assign(kSides, {});
  std::vector<std::span<LightRecord>> leaves;
  auto begin = records.begin();
  for (uint32_t side = 0; side < kSides; ++side) {
    const auto end = std::partition(begin, records.end(),
                                    [&](const auto& r) { return sideOf(r.normal) == side; });
    divide(side, {begin, end}, leaves);
    begin = end;
  }
  regions_.assign(leaves.size(), {});
  tbb::parallel_for(size_t(0), leaves.size(),
                    [&](size_t i) { regions_[i] = GuideRegion(leaves[i]); });
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
