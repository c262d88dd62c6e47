// SPDX-License-Identifier: Apache-2.0
// Lines of progress off a terminal, and the time that is kept for the end of a render.
#include <gtest/gtest.h>

#include <cmath>

#include "base/progress.h"
#include "session/render_loaded.h"

namespace chromeball::progress_test {
namespace {

// The seconds at which a render of this length prints lines.
std::vector<int> linesOf(int seconds, bool knowsFraction = true) {
  LineTimes lines;
  std::vector<int> printed;
  for (int s = 0; s < seconds; ++s)
    if (lines.isDue(knowsFraction ? double(s) / seconds : NAN, s)) printed.push_back(s);
  return printed;
}

TEST(ProgressLines, EveryTenthOrMinute) {
  EXPECT_EQ(linesOf(10), std::vector<int>{}) << "short work is silent";
  EXPECT_EQ(linesOf(40), (std::vector<int>{10, 20, 30})) << "not more often";
  EXPECT_EQ(linesOf(400), (std::vector<int>{40, 80, 120, 160, 200, 240, 280, 320, 360}));
  EXPECT_EQ(linesOf(4000).size(), 69u) << "six minutes and a tenth, ten times";
  EXPECT_EQ(linesOf(200, false), (std::vector<int>{60, 120, 180}));
}

RenderDescription timed(double seconds, const std::vector<std::string>& files) {
  RenderDescription d;
  d.settings.timeLimit = seconds;
  d.output.files = files;
  return d;
}

TEST(TimeKept, ForDenoisingAndWriting) {
  RenderDescription plain = timed(100, {"a.exr"}), denoised = plain;
  plain.output.layers = {"normal", "depth"};  // as many as denoising adds
  denoised.settings.denoise = true;
  const KeptTime less = keepTime(plain), more = keepTime(denoised);
  EXPECT_GT(less.seconds, 0);
  EXPECT_GT(more.seconds, less.seconds);
  EXPECT_DOUBLE_EQ(*more.settings.timeLimit + more.seconds, 100);
  EXPECT_GT(keepTime(timed(100, {"a.exr", "a.png"})).seconds,
            keepTime(timed(100, {"a.exr"})).seconds);
}

TEST(TimeKept, LeavesTimeForSamples) {
  RenderDescription d = timed(1e-3, {"a.exr"});
  d.settings.denoise = true;
  EXPECT_GE(*keepTime(d).settings.timeLimit, 0.25e-3);
  EXPECT_EQ(keepTime(timed(5, {})).seconds, 0) << "a program's own render writes nothing";
  d.settings.timeLimit.reset();
  EXPECT_FALSE(keepTime(d).settings.timeLimit);
}

}  // namespace
}  // namespace chromeball::progress_test
