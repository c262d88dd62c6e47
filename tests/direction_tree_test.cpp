// SPDX-License-Identifier: Apache-2.0
// The quadtree of a guide: a density over the sphere that its samples follow.
#include "guiding/light_guide.h"

#include <gtest/gtest.h>

#include "math/sampler.h"
#include "sphere_test.h"

namespace chromeball::direction_tree_test {
namespace {

using Points = std::vector<DirectionTree::Point>;

float random(uint64_t i, uint64_t purpose) { return toUnit(uint32_t(hash(i, purpose))); }

// A wide lobe, a narrow one with the same weight, and a few points elsewhere.
Points twoLobes(size_t count) {
  Points points;
  for (size_t i = 0; i < count; ++i) {
    const float size = i % 2 == 0 ? 0.4f : 0.003f;
    const vec2 centre = i % 2 == 0 ? vec2(0.5f, 0.3f) : vec2(0.123f, 0.77f);
    points.push_back({centre + size * vec2(random(i, 1) - 0.5f, random(i, 2) - 0.5f), 1});
    if (i % 50 == 0) points.push_back({{random(i, 3), random(i, 4)}, 0.5f});
  }
  return points;
}

SphereTest test(const DirectionTree& tree) {
  const auto draw = [&](int i) -> std::optional<vec3> {
    return tree.sample({random(uint64_t(i), 5), random(uint64_t(i), 6)}).direction;
  };
  return testDirections(
      draw, [&](const vec3& w) { return double(tree.pdf(w)); }, 200'000, 5);
}

TEST(SlowDirectionTree, SamplesFollowThePdf) {
  Points lobes = twoLobes(5000), few = twoLobes(20);
  for (const DirectionTree& tree : {DirectionTree(lobes), DirectionTree(few), DirectionTree()}) {
    const SphereTest result = test(tree);
    EXPECT_NEAR(result.totalProbability, 1, 2e-3);
    EXPECT_GT(result.chiSquare.pValue, sidak(1e-3, 3));
  }
}

TEST(DirectionTree, ASampleHasThePdfOfItsDirection) {
  Points points = twoLobes(5000);
  const DirectionTree tree(points);
  int different = 0;
  for (uint64_t i = 0; i < 10'000; ++i) {
    const auto sample = tree.sample({random(i, 5), random(i, 6)});
    EXPECT_NEAR(glm::length(sample.direction), 1, 1e-5f);
    different += std::fabs(sample.pdf / tree.pdf(sample.direction) - 1) > 1e-4f;
  }
  EXPECT_LT(different, 20);  // rounding at the borders of leaves
}

TEST(DirectionTree, FindsANarrowLobe) {
  Points points = twoLobes(5000);
  const DirectionTree tree(points);
  const vec3 narrow = squareToUniformSphere({0.123f, 0.77f});
  const vec3 dark = squareToUniformSphere({0.9f, 0.9f});
  // Half of the weight lies on 9e-6 of the sphere, and the finest leaves have 1e-6 of it.
  EXPECT_GT(tree.pdf(narrow), 1000.0f);
  EXPECT_LT(tree.pdf(narrow), 0.5f / (4 * kPi * 9e-6f) * 2);
  EXPECT_GT(tree.pdf(dark), 0);
  EXPECT_LT(tree.pdf(dark), 0.01f);
}

TEST(DirectionTree, BearsAnyWeights) {
  for (const float weight : {0.0f, 1e-30f, 1e30f}) {
    Points same(1000, {{0.3f, 0.6f}, weight});
    const DirectionTree tree(same);
    EXPECT_LT(tree.byteCount(), 1000u);
    for (uint64_t i = 0; i < 100; ++i) {
      const auto sample = tree.sample({random(i, 5), random(i, 6)});
      EXPECT_TRUE(std::isfinite(sample.pdf) && sample.pdf > 0) << weight;
    }
  }
  Points none;
  EXPECT_NEAR(DirectionTree(none).pdf({0, 1, 0}), squareToUniformSpherePdf(), 1e-7f);
  for (const vec2 corner : {vec2(0), vec2(0x1.fffffep-1f)})
    EXPECT_TRUE(std::isfinite(DirectionTree(none).sample(corner).pdf));
}

}  // namespace
}  // namespace chromeball::direction_tree_test
