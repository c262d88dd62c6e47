// SPDX-License-Identifier: Apache-2.0
// What a comparison says of strategies whose samples have not found rare bright light: from
// images that are made up, as if they had been rendered.
#include <gtest/gtest.h>

#include <random>

#include "base/json.h"
#include "study/result_tables.h"
#include "temporary_folder.h"

namespace chromeball::found_light_test {
namespace {

const Budget kBudget{false, 4};
constexpr ImageSize kSize{16, 12};
constexpr int kRepeats = 4;

Image noisy(float mean, float noise, std::mt19937& random) {
  std::normal_distribution<float> normal(mean, noise);
  Image image(kSize.width, kSize.height, 3);
  for (float& texel : image.texels) texel = normal(random);
  return image;
}

// The reference is 1.
class FoundLightStudy : public testing::Test {
 protected:
  FoundLightStudy() {
    study_.folder = folder_ / "study";
    study_.identity = "{}";
    study_.repeats = kRepeats;
    study_.budgets = study_.shownBudgets = {kBudget};
    reference_.mean = reference_.squaredError = Image(kSize.width, kSize.height, 3);
    std::ranges::fill(reference_.mean.texels, 1.f);
    std::ranges::fill(reference_.squaredError.texels, 1e-6f);
    store_.makeFolder();
  }

  void add(const std::string& name, float mean, float noise, bool unbiased = true) {
    study_.strategies.push_back(name);
    study_.shownStrategies.push_back(name);
    for (int repeat = 0; repeat < kRepeats; ++repeat)
      store_.save({name, kBudget, repeat},
                  {.unbiased = unbiased, .image = noisy(mean, noise, random_), .seconds = 1});
  }
  StudyResults results() const { return studyResults(study_, store_, reference_); }

  TemporaryFolder folder_;
  Study study_;
  RenderStore store_{study_, kSize};
  Reference reference_;
  std::mt19937 random_{3};
};

TEST_F(FoundLightStudy, MissedLightIsToldAndIsNoBias) {
  add("bsdf", 0.82f, 0.01f);
  add("importance", 1, 0.3f);
  add("uniform", 0.8f, 0.01f);
  add("suns", 0.9f, 0.01f, false);
  const StudyResults found = results();
  ASSERT_EQ(found.warnings.size(), 1u);
  EXPECT_EQ(found.warnings[0],
            "The samples of bsdf, uniform have not found light that the reference has (-18%, -20% "
            "of it), such as a small sun: errors, bias and verdict of such rows mean nothing. Give "
            "more samples or repeats.");
  EXPECT_EQ(found.baseline, "importance");
  EXPECT_TRUE(found.pairs.empty()) << found.pairs[0].a << " " << found.pairs[0].b;
  EXPECT_TRUE(std::isnan(found.strategies[0].cells[0].efficiency.value));
  const auto best = ranking(study_, found);
  EXPECT_EQ(best[0]->strategy, "suns");
  EXPECT_EQ(best[1]->strategy, "importance");

  const nlohmann::ordered_json json = resultsJson(study_, found, {});
  EXPECT_EQ(json["strategies"][0]["cells"][0]["missed_light"], true);
  EXPECT_EQ(json["strategies"][3]["cells"][0]["missed_light"], false);
  EXPECT_TRUE(json["strategies"][0]["cells"][0]["efficiency"]["mean"].is_null());
}

TEST_F(FoundLightStudy, RowsThatMissAreNoBaselineOfTheirOwnAccord) {
  add("bsdf", 0.82f, 0.01f);
  add("suns", 0.99f, 0.3f, false);
  EXPECT_EQ(results().baseline, "suns");
  study_.baseline = "bsdf";
  const StudyResults given = results();
  ASSERT_EQ(given.warnings.size(), 2u);
  EXPECT_TRUE(given.warnings[1].starts_with("Efficiencies are relative to bsdf, which has not"));
}

// A file may show another scene: that all rows are darker is then no matter of samples.
TEST_F(FoundLightStudy, AGivenReferenceMayBeOfAnotherScene) {
  add("bsdf", 0.82f, 0.01f);
  study_.referenceFile = "reference.exr";
  const StudyResults found = results();
  ASSERT_EQ(found.warnings.size(), 1u);
  EXPECT_NE(found.warnings[0].find("unless the reference is of another scene"), std::string::npos);
}

// Each row is in one warning alone.
TEST_F(FoundLightStudy, BrightSamplesAreTellingWhereTheyAreMet) {
  add("bsdf", 0.82f, 0.01f);
  add("uniform", 1, 3);
  const StudyResults found = results();
  ASSERT_EQ(found.warnings.size(), 2u);
  EXPECT_TRUE(found.warnings[0].starts_with("The samples of bsdf have")) << found.warnings[0];
  EXPECT_NE(found.warnings[1].find("most of the error of uniform:"), std::string::npos);
}

TEST(FoundLight, IsMissedWhereAnUnbiasedMeanIsSignificantlyLow) {
  const auto of = [](const Estimate& bias, bool unbiased = true, double relMse = 0.01) {
    BiasVariance error;
    error.bias = bias;
    error.relMse = {relMse, 0.001};
    return foundLight(error, unbiased);
  };
  EXPECT_EQ(of({-0.18, 0.002}), FoundLight::Missed);
  EXPECT_EQ(of({-0.18, 0.002}, true, 2), FoundLight::Missed);
  EXPECT_EQ(of({-0.18, 0.002}, false), FoundLight::All) << "its bias";
  EXPECT_EQ(of({-0.18, 0.06}), FoundLight::All) << "noise";
  EXPECT_EQ(of({-0.18, 0.06}, true, 2), FoundLight::Few);
  EXPECT_EQ(of({0.18, 0.002}), FoundLight::All) << "brighter";
  EXPECT_EQ(of({-0.001, 1e-6}), FoundLight::All) << "rounding";
  EXPECT_EQ(of({std::nan(""), 0}), FoundLight::All) << "of a black reference";
}

}  // namespace
}  // namespace chromeball::found_light_test
