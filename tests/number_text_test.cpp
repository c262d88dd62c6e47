// SPDX-License-Identifier: Apache-2.0
// Numbers in options and text files, with or without a sign.
#include "base/text.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "front/arguments.h"
#include "relight/stage/light_stage.h"
#include "scene/solve/observations.h"
#include "temporary_folder.h"

namespace chromeball::number_text_test {
namespace {

TEST(NumberText, MayHaveAPlus) {
  for (const auto& [text, expected] : {std::pair("+286.5", 286.5), std::pair("286.5", 286.5),
                                       std::pair("-2", -2.0), std::pair("+1e-3", 1e-3)}) {
    double number = 0;
    EXPECT_TRUE(toNumber(text, number)) << text;
    EXPECT_EQ(number, expected) << text;
  }
  for (const char* text : {"", "+", "+-1", "++1", "-+1", "+ 1", "1+", "+a"}) {
    double number = 0;
    EXPECT_FALSE(toNumber(text, number)) << text;
  }
  std::string_view text = "+3,4";
  int number = 0;
  ASSERT_TRUE(takeNumber(text, number));
  EXPECT_EQ(number, 3);
  EXPECT_EQ(text, ",4");
}

TEST(NumberText, InListsAndTables) {
  EXPECT_EQ(parseNumbers("+1.5,-2,+3", 3, "test"), (std::vector<double>{1.5, -2, 3}));
  EXPECT_THROW(parseNumbers("+-1", 1, "test"), InputError);
  const TemporaryFolder folder;
  std::ofstream(folder / "points.csv") << "name,x,y,z,px,py\np0,-0.5,+0.5,+.25,+286.5,296.1\n";
  const auto points = readObservedPoints(folder / "points.csv");
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].pixel, glm::dvec2(286.5, 296.1));
  std::ofstream(folder / "photographs.csv") << "a.exr,+0,0,+1\nb.exr,+.6,-0.8,0\n";
  EXPECT_EQ(readPhotographs(folder / "photographs.csv").size(), 2u);
}

}  // namespace
}  // namespace chromeball::number_text_test
