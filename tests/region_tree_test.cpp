// SPDX-License-Identifier: Apache-2.0
// The regions of the guides.
#include "guiding/region_tree.h"

#include <gtest/gtest.h>

#include "sphere_test.h"

namespace chromeball::region_tree_test {
namespace {

struct Record {
  vec3 position, normal;
};

void expectConsistent(const RegionTree& tree, const std::vector<std::span<Record>>& regions) {
  for (size_t i = 0; i < regions.size(); ++i)
    for (const Record& r : regions[i]) EXPECT_EQ(tree.find(r.position, r.normal), i);
}

TEST(RegionTree, HasRegionsOfEqualNumbers) {
  std::vector<Record> records;
  for (int i = 0; i < 6400; ++i)
    records.push_back(
        {{random1(i, 0), random1(i, 1), random1(i, 2)}, {0, i % 2 ? 1.0f : -1.0f, 0}});
  std::vector<std::span<Record>> regions;
  const RegionTree tree{std::span<Record>(records), 100, regions};
  expectConsistent(tree, regions);
  EXPECT_EQ(regions.size(), 4u + 64u);  // four sides have no records
  for (const auto& region : regions) EXPECT_TRUE(region.empty() || region.size() == 100);
}

// Most records are on a wall, and so have the same coordinate along the longest axis.
TEST(RegionTree, DividesAWallBehindOtherThings) {
  std::vector<Record> records;
  for (int i = 0; i < 10'000; ++i) {
    const bool isWall = i % 5 > 0;
    records.push_back({{random1(i, 0), random1(i, 1), isWall ? -3 : 9 * random1(i, 2)}, {0, 0, 1}});
  }
  std::vector<std::span<Record>> regions;
  const RegionTree tree{std::span<Record>(records), 100, regions};
  expectConsistent(tree, regions);
  for (const auto& region : regions) {
    EXPECT_LT(region.size(), 200u);
    size_t onWall = 0;
    for (const Record& r : region) onWall += r.position.z == -3;
    EXPECT_TRUE(onWall == 0 || onWall == region.size());
  }
}

TEST(RegionTree, EndsWithEqualPositions) {
  std::vector<Record> records(1000, {{1, 2, 3}, {1, 0, 0}});
  records.push_back({{1, 2, 4}, {1, 0, 0}});
  std::vector<std::span<Record>> regions;
  const RegionTree tree{std::span<Record>(records), 100, regions};
  expectConsistent(tree, regions);
  EXPECT_EQ(regions.size(), 6u);
}

}  // namespace
}  // namespace chromeball::region_tree_test
