// SPDX-License-Identifier: Apache-2.0
// What a comparison concludes from its numbers: intervals of ratios, and the verdict in words.
#include <gtest/gtest.h>

#include <random>

#include "measure/statistics.h"
#include "study/result_tables.h"

namespace chromeball::verdict_test {
namespace {

const Budget kBudget{false, 16};

StrategyResult strategy(const std::string& name, const Estimate& relMse, double seconds,
                        bool unbiased = true, const Estimate& bias = {}) {
  StrategyResult result{.name = name, .unbiased = unbiased};
  Cell cell{.strategy = name, .budget = kBudget};
  cell.error.relMse = relMse;
  cell.error.bias = bias;
  cell.light = foundLight(cell.error, unbiased);
  cell.repeatSeconds = {seconds, seconds, 1.01 * seconds, 0.99 * seconds};
  result.cells.push_back(cell);
  return result;
}

std::vector<std::string> verdictOf(const std::vector<StrategyResult>& strategies) {
  StudyResults results;
  results.strategies = strategies;
  Study study;
  study.shownBudgets = {kBudget};
  for (StrategyResult& one : results.strategies) {
    study.strategies.push_back(one.name);
    for (Cell& cell : one.cells)
      cell.efficiency = relativeEfficiency(cell, results.strategies.front().cells.front());
  }
  return verdict(study, results);
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// A strategy that hardly ever finds the sun: one pixel is most of its error.
TEST(Verdict, NoiseDoesNotHideALargeRatio) {
  const auto found =
      verdictOf({strategy("bsdf", {685, 680}, 1), strategy("importance", {0.0045, 0.0001}, 1)});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(
      found[0].starts_with("Use importance: at equal time bsdf, the next best, has 150000 "))
      << found[0];
  EXPECT_FALSE(contains(found[0], "significant"));
}

TEST(Verdict, NamesThoseThatDoNotDiffer) {
  const auto found =
      verdictOf({strategy("a", {0.0100, 0.0005}, 1), strategy("b", {0.0102, 0.0005}, 1),
                 strategy("c", {0.04, 0.001}, 1)});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(
      found[0].starts_with("Use a or b: no significant difference between them at equal "
                           "time; c, the next best, has 4"))
      << found[0];
}

TEST(Verdict, CountsTimeAsWellAsError) {
  const auto found =
      verdictOf({strategy("slow", {0.01, 0.0001}, 8), strategy("fast", {0.02, 0.0002}, 1)});
  EXPECT_TRUE(found[0].starts_with("Use fast: at equal time slow, the next best, has 4"))
      << found[0];
}

TEST(Verdict, HasOneLineForTheBiased) {
  const StrategyResult best = strategy("importance", {0.01, 0.0001}, 1);
  StrategyResult better = strategy("median-cut:16", {0.005, 0.0001}, 1, false);
  better.biasEqualsNoise = Crossing{120, 100, 140};
  const StrategyResult worse = strategy("penrose:300", {0.1, 0.001}, 1, false);
  const auto found = verdictOf({best, better, worse});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0], "Use importance.");
  EXPECT_TRUE(found[1].starts_with("Of 2 biased, better at equal time: median-cut:16 by 2"))
      << found[1];
  EXPECT_TRUE(contains(found[1], "at 120 samples per pixel")) << found[1];
  EXPECT_FALSE(contains(found[1], "penrose")) << found[1];
  EXPECT_EQ(verdictOf({best, worse})[1],
            "Of 1 biased, none is significantly better at equal time.");
  EXPECT_EQ(verdictOf({better, worse})[1], "All of them are biased.");
}

// The table lists both kinds, so that the second of the unbiased need not be its second row.
TEST(Verdict, SaysWhatIsTheNextBestOf) {
  const StrategyResult best = strategy("importance", {0.01, 0.0001}, 1);
  const StrategyResult next = strategy("bsdf", {0.04, 0.0004}, 1);
  for (const double error : {0.005, 0.02}) {  // before the best, and between
    const auto found = verdictOf({best, strategy("suns", {error, 0.0002}, 1, false), next});
    EXPECT_TRUE(found[0].starts_with(
        "Use importance: at equal time bsdf, the next best of the unbiased, has 4 "))
        << found[0];
  }
  const auto found = verdictOf({best, next, strategy("median-cut:4", {0.1, 0.001}, 1, false)});
  EXPECT_TRUE(found[0].starts_with("Use importance: at equal time bsdf, the next best, has 4 "))
      << found[0];
}

// Without the sun that none of its samples has met, an unbiased strategy is dark, and its error is
// the smallest of all.
TEST(Verdict, HasNoUseForRowsThatHaveMissedLight) {
  const StrategyResult good = strategy("importance", {0.01, 0.0001}, 1);
  const StrategyResult dark = strategy("bsdf", {0.001, 1e-5}, 1, true, {-0.181, 0.002});
  const StrategyResult darker = strategy("uniform", {0.002, 1e-5}, 1, true, {-0.2, 0.002});
  const StrategyResult biased = strategy("suns", {0.02, 0.0001}, 1, false, {-0.181, 0.002});
  EXPECT_EQ(verdictOf({good, dark, darker}), std::vector<std::string>{"Use importance."});
  EXPECT_EQ(verdictOf({good, dark, biased}),
            (std::vector<std::string>{"Use importance.",
                                      "Of 1 biased, none is significantly better at equal time."}));
  EXPECT_EQ(verdictOf({dark, darker}),
            (std::vector<std::string>{"None has found all light that the reference has: give more "
                                      "samples or repeats."}));
  EXPECT_EQ(verdictOf({dark, biased}),
            (std::vector<std::string>{"Use suns.", "All of them are biased.",
                                      "None of the unbiased has found all light that the reference "
                                      "has: give more samples or repeats."}));
}

// An error below the noise of the reference, which was subtracted, is about as small as that noise.
TEST(Verdict, KnowsThatAnErrorBelowTheReferencesNoiseIsSmall) {
  for (const double mean : {-0.001, 0.0, 0.0003}) {
    const auto found =
        verdictOf({strategy("bsdf", {56, 40}, 1), strategy("importance", {mean, 0.0009}, 1),
                   strategy("median-cut:8", {0.4, 0.01}, 1, false)});
    ASSERT_EQ(found.size(), 2u);
    EXPECT_TRUE(found[0].starts_with(
        "Use importance: at equal time bsdf, the next best of the unbiased, has 6"))
        << found[0];
    EXPECT_EQ(found[1], "Of 1 biased, none is significantly better at equal time.");
  }
  const auto found =
      verdictOf({strategy("a", {0.01, 0.0001}, 1), strategy("b", {-0.001, 0.01}, 1)});
  EXPECT_TRUE(found[0].starts_with("Use a or b: no significant difference")) << found[0];
}

// Times with lognormal scatter, and four repeats: Student's quantile is needed.
TEST(Ratio, PairedIntervalsCoverTheTruth) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  constexpr int kStudies = 4000;
  int covered = 0;
  for (int study = 0; study < kStudies; ++study) {
    std::vector<double> a, b;
    for (int r = 0; r < 4; ++r) {
      const double drift = std::exp(normal(random));  // slows both
      a.push_back(3 * drift * std::exp(0.2 * normal(random)));
      b.push_back(drift * std::exp(0.2 * normal(random)));
    }
    const RatioEstimate ratio = pairedRatio(a, b);
    covered += ratio.low() <= 3 && 3 <= ratio.high();
  }
  EXPECT_NEAR(double(covered) / kStudies, 0.95, 4 * std::sqrt(0.95 * 0.05 / kStudies));
}

// Means of squared errors of which three in 4000 pixels are nearly all, as of a strategy that
// hardly finds a lamp. Where no pixel found it, in one of 20, no interval covers the truth; the
// linear one reaches below 0, and not far enough up.
TEST(Ratio, IntervalsCoverTheTruthUnderFireflies) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> unit;
  constexpr int kStudies = 1000, kPixels = 4000;
  constexpr double kRare = 3.0 / kPixels, kBright = 1000, kTruth = kRare * kBright + 5e-4;
  int covered = 0, linear = 0;
  for (int study = 0; study < kStudies; ++study) {
    std::vector<double> errors;
    for (int i = 0; i < kPixels; ++i)
      errors.push_back(1e-3 * unit(random) + (unit(random) < kRare ? kBright : 0));
    const Estimate noisy = meanOf(errors);
    const RatioEstimate times = ratio(noisy, {1, 0.01});
    covered += times.low() <= kTruth && kTruth <= times.high();
    linear += noisy.low() <= kTruth && kTruth <= noisy.high();
  }
  EXPECT_GT(covered, 0.89 * kStudies);
  EXPECT_LT(linear, 0.85 * kStudies);
}

TEST(Ratio, IsUnknownWithoutAPositiveNumber) {
  EXPECT_TRUE(std::isnan(ratio({-1, 1}, {1, 1}).value));
  EXPECT_EQ(ratioText(ratio({1, 1}, {0, 0})), "unknown");
  EXPECT_EQ(ratioText({1, 0}), "1");
  EXPECT_EQ(ratioText({1.386, 0.05}), "1.39 (1.26 to 1.53)");
  EXPECT_EQ(positiveText({685, 680}), "690 (98 to 4800)");
  EXPECT_EQ(positiveText({1e-5, 1e-4}), "not significant (+- 0.0002)");
}

TEST(Bias, OfARowThatHasMissedLightIsNoneOfItsMethod) {
  EXPECT_EQ(biasText({-0.181, 0.002}, FoundLight::All), "-18.1 +- 0.4");
  EXPECT_EQ(biasText({-0.181, 0.002}, FoundLight::Missed), "-18.1 (light not found)");
}

}  // namespace
}  // namespace chromeball::verdict_test
