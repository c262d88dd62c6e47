// SPDX-License-Identifier: Apache-2.0
#include "base/text.h"

#include <gtest/gtest.h>

namespace chromeball::suggest_test {
namespace {

TEST(Suggest, DistanceCountsEachKindOfEditOnce) {
  EXPECT_EQ(editDistance("samples", "samples"), 0);
  EXPECT_EQ(editDistance("samples", "smaples"), 1);   // swap
  EXPECT_EQ(editDistance("samples", "sample"), 1);    // delete
  EXPECT_EQ(editDistance("samples", "sammples"), 1);  // insert
  EXPECT_EQ(editDistance("samples", "samplez"), 1);   // replace
  EXPECT_EQ(editDistance("kitten", "sitting"), 3);
  EXPECT_EQ(editDistance("", "probe"), 5);
  EXPECT_EQ(editDistance("probe", ""), 5);
  EXPECT_EQ(editDistance("", ""), 0);
}

TEST(Suggest, DistanceIsSymmetric) {
  const std::vector<std::string_view> words{"", "a", "ab", "ba", "max_depth", "depth_max", "fov"};
  for (auto a : words)
    for (auto b : words) EXPECT_EQ(editDistance(a, b), editDistance(b, a)) << a << " " << b;
}

TEST(Suggest, NearestHasTheMinimumDistanceAndIsTheFirstOfEquals) {
  EXPECT_EQ(nearestName("sampels", {"size", "samples", "seed"}), "samples");
  EXPECT_EQ(nearestName("tame", {"time", "name"}), "time");
  EXPECT_EQ(nearestName("max-depth", {"size", "max_depth"}), "max_depth");
}

TEST(Suggest, NoNameIsNearIfMostLettersDiffer) {
  EXPECT_EQ(nearestName("x", {"up", "fov"}), "");
  EXPECT_EQ(nearestName("probe", {}), "");
  EXPECT_EQ(nearestName("wattage", {"size", "seed"}), "");
  EXPECT_EQ(nearestName(std::string(4 << 20, 's'), {"samples", "seed", "size"}), "");
  const std::string endless(1 << 20, 's'), other = endless + "t";  // would take an hour
  EXPECT_EQ(nearestName(endless, {other}), "");
}

TEST(Suggest, SameNamesDifferInDashesAndCapitalsAlone) {
  EXPECT_EQ(sameName("--lookat", {"--look", "--look-at"}), "--look-at");
  EXPECT_EQ(sameName("LookAt", {"look_at_node", "look_at"}), "look_at");
  EXPECT_EQ(sameName("lookatt", {"look_at"}), "");
  EXPECT_EQ(sameName("--", {"", "-"}), "");
}

TEST(Suggest, MessageHasTheNearestNameOrAllNames) {
  EXPECT_EQ(didYouMean("sized", {"size", "seed"}), "did you mean `size`?");
  EXPECT_EQ(didYouMean("wattage", {"size", "seed"}), "known: size, seed");
}

}  // namespace
}  // namespace chromeball::suggest_test
