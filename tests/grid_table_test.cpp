// SPDX-License-Identifier: Apache-2.0
// Grid tables: interpolation, and clamping at the edges.
#include <gtest/gtest.h>

#include "math/grid_table.h"
#include "sphere_test.h"

namespace chromeball::grid_table_test {
namespace {

using Grid = GridTable<float, 5, 2, 9>;  // steps of 1/4, 1 and 1/8: nodes are exact in binary

float multilinear(float x, float y, float z) {
  return 1 + 2 * x - 3 * y + 4 * z + 5 * x * y - 6 * y * z + 7 * z * x - 8 * x * y * z;
}

Grid multilinearGrid() {
  Grid grid;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 2; ++j)
      for (int k = 0; k < 9; ++k)
        grid.node({i, j, k}) = multilinear(float(i) / 4, float(j), float(k) / 8);
  return grid;
}

Grid::Position positionAt(float x, float y, float z) {
  return {GridPosition(x, 5), GridPosition(y, 2), GridPosition(z, 9)};
}

float weightedSum(const Grid& grid, const Grid::Position& position) {
  float sum = 0;
  grid.forCorners(position, [&](float value, float weight) { sum += weight * value; });
  return sum;
}

TEST(GridTable, reproducesMultilinearFunctions) {
  const Grid grid = multilinearGrid();
  for (int i = 0; i < 1000; ++i) {
    const vec2 xy = random2(i, 0);
    const float z = random1(i, 2);
    const float exact = multilinear(xy.x, xy.y, z);
    ASSERT_NEAR(grid.interpolate(positionAt(xy.x, xy.y, z)), exact, 1e-5f);
    ASSERT_NEAR(weightedSum(grid, positionAt(xy.x, xy.y, z)), exact, 1e-5f);
  }
}

TEST(GridTable, returnsItsNodesExactly) {
  Grid grid = multilinearGrid();
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 2; ++j)
      for (int k = 0; k < 9; ++k) {
        const auto at = positionAt(float(i) / 4, float(j), float(k) / 8);
        ASSERT_EQ(grid.interpolate(at), grid.node({i, j, k}));
        ASSERT_EQ(weightedSum(grid, at), grid.node({i, j, k}));
      }
}

TEST(GridTable, clampsAtItsEdges) {
  const Grid grid = multilinearGrid();
  for (const float beyond : {1.0000002f, 1.5f, 1e30f, INFINITY})
    EXPECT_EQ(grid.interpolate(positionAt(beyond, beyond, beyond)), multilinear(1, 1, 1));
  for (const float below : {-1e-7f, -0.5f, -1e30f, -INFINITY, std::nanf("")})
    EXPECT_EQ(grid.interpolate(positionAt(below, below, below)), multilinear(0, 0, 0));
  EXPECT_EQ(grid.interpolate(positionAt(2, 0.5f, -1)), multilinear(1, 0.5f, 0));
}

// The last node is the upper end of the last cell, so that nothing is read beyond the table.
TEST(GridTable, positionsLieBetweenTwoNodes) {
  for (const int nodes : {2, 3, 64})
    for (int i = 0; i <= 100; ++i) {
      const GridPosition p(float(i) / 100, nodes);
      EXPECT_GE(p.low, 0);
      EXPECT_LE(p.low, nodes - 2);
      EXPECT_GE(p.blend, 0);
      EXPECT_LE(p.blend, 1);
      EXPECT_NEAR((float(p.low) + p.blend) / float(nodes - 1), float(i) / 100, 1e-6f);
    }
}

// Values of a user-defined type are interpolated by the type's own mix().
struct Pair {
  float a, b;
  friend Pair mix(const Pair& x, const Pair& y, float t) {
    return {x.a + t * (y.a - x.a), x.b + t * (y.b - x.b)};
  }
};

TEST(GridTable, interpolatesValuesOfAnyType) {
  GridTable<Pair, 2> line;
  line.node({0}) = {1, 10};
  line.node({1}) = {3, 30};
  const Pair middle = line.interpolate({GridPosition(0.5f, 2)});
  EXPECT_EQ(middle.a, 2);
  EXPECT_EQ(middle.b, 20);
}

}  // namespace
}  // namespace chromeball::grid_table_test
