// SPDX-License-Identifier: Apache-2.0
// Divides the surfaces of a scene into regions with about the same number of records each.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/archive.h"
#include "math/vec.h"

namespace chromeball {

// The regions are the leaves of k-d trees, one for each of the six axes that a normal can be
// nearest to. A record has a position and a unit normal.
class RegionTree {
 public:
  RegionTree() = default;
  // Divides at the median along the longest axis, or above it where many records have the smallest
  // coordinate, while both parts have at least `minRecords`.
  // Reorders the records.
  template <class Record>
  RegionTree(std::span<Record> records, size_t minRecords, std::vector<std::span<Record>>& regions);

  bool empty() const { return nodes_.empty(); }
  // `regions`: their number.
  void archive(Archive& a, size_t regions) {
    a(nodes_);
    a.check(nodes_.empty() || nodes_.size() >= kSides);
    for (size_t i = 0; i < nodes_.size(); ++i) {
      const Node& node = nodes_[i];
      a.check(node.axis == kLeaf
                  ? node.index < regions
                  : node.axis < kLeaf && node.index > i && size_t(node.index) + 1 < nodes_.size());
    }
  }
  // The index of a region.
  uint32_t find(const vec3& position, const vec3& normal) const {
    const Node* node = &nodes_[sideOf(normal)];
    while (node->axis != kLeaf)
      node = &nodes_[node->index + (position[int(node->axis)] >= node->split)];
    return node->index;
  }

 private:
  static constexpr uint32_t kSides = 6, kLeaf = 3;
  struct Node {
    float split;     // positions below it are in the first child
    uint32_t axis;   // kLeaf for a region
    uint32_t index;  // of the first child, which the second follows; or of the region
  };

  // Which of six axes is nearest to the normal.
  static uint32_t sideOf(const vec3& n) {
    const vec3 a = absolute(n);
    const uint32_t axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return 2 * axis + (n[int(axis)] < 0);
  }
  // Reorders the records for a split of the node along the longest axis that allows one; returns
  // the first record above it, or the first of all if no axis allows one.
  template <class Record>
  auto split(size_t node, std::span<Record> records, size_t minRecords);
  template <class Record>
  void divide(size_t node, std::span<Record> records, size_t minRecords,
              std::vector<std::span<Record>>& regions);

  std::vector<Node> nodes_;  // the first six are roots
};

template <class Record>
RegionTree::RegionTree(std::span<Record> records, size_t minRecords,
                       std::vector<std::span<Record>>& regions)
    : nodes_(kSides) {
  auto begin = records.begin();
  for (uint32_t side = 0; side < kSides; ++side) {
    const auto end = std::partition(begin, records.end(),
                                    [&](const Record& r) { return sideOf(r.normal) == side; });
    divide(side, std::span<Record>(begin, end), minRecords, regions);
    begin = end;
  }
}

template <class Record>
auto RegionTree::split(size_t node, std::span<Record> records, size_t minRecords) {
  if (records.size() < 2 * minRecords) return records.begin();
  vec3 low(INFINITY), high(-INFINITY);
  for (const Record& r : records) {
    low = glm::min(low, r.position);
    high = glm::max(high, r.position);
  }
  std::array<int, 3> axes = {0, 1, 2};
  std::ranges::stable_sort(axes, std::greater(), [&](int axis) { return (high - low)[axis]; });
  for (const int axis : axes) {
    const auto middle = records.begin() + std::ptrdiff_t(records.size() / 2);
    std::nth_element(records.begin(), middle, records.end(), [&](const auto& a, const auto& b) {
      return a.position[axis] < b.position[axis];
    });
    float at = middle->position[axis];
    if (at == low[axis]) {  // of at least half the records, as on a wall
      at = high[axis];
      for (const Record& r : records)
        if (r.position[axis] > low[axis]) at = std::min(at, r.position[axis]);
    }
    const auto right = std::partition(records.begin(), records.end(),
                                      [&](const auto& r) { return r.position[axis] < at; });
    const size_t count = size_t(right - records.begin());
    if (count < minRecords || records.size() - count < minRecords) continue;
    nodes_[node] = {at, uint32_t(axis), 0};
    return right;
  }
  return records.begin();
}

template <class Record>
void RegionTree::divide(size_t node, std::span<Record> records, size_t minRecords,
                        std::vector<std::span<Record>>& regions) {
  const auto right = split(node, records, minRecords);
  if (right == records.begin()) {
    nodes_[node] = {0, kLeaf, uint32_t(regions.size())};
    regions.push_back(records);
    return;
  }
  const size_t child = nodes_.size();
  nodes_[node].index = uint32_t(child);
  nodes_.resize(child + 2);
  divide(child, std::span<Record>(records.begin(), right), minRecords, regions);
  divide(child + 1, std::span<Record>(right, records.end()), minRecords, regions);
}

}  // namespace chromeball
