// SPDX-License-Identifier: Apache-2.0
// All unbiased strategies, with every MIS heuristic, render the same image: Welch's t-test over
// independent seeds on each tile, Sidak-corrected.
#include <gtest/gtest.h>

#include "lighting/methods.h"
#include "measure/statistics.h"
#include "probe/synth.h"
#include "small_scenes.h"

namespace chromeball::strategies_test {
namespace {

constexpr int kSize = 32, kTile = 8, kRepeats = 12;

// Tile means, indexed [tile x 3 + channel][repeat].
std::vector<std::vector<double>> tileMeans(const NamedScene& named, const char* strategy, Mis mis,
                                           uint64_t firstSeed) {
  const int tiles = kSize / kTile;
  std::vector<std::vector<double>> means(size_t(tiles * tiles * 3));
  const Camera camera = Camera::lookAt({0.5f, 2.5f, 4}, {0, 0.5f, 0}, {0, 1, 0}, 0.7f);
  const Probe probe(named.probe, 25);
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    RenderSettings settings = smallRender(kSize, kSize, 64, 6, firstSeed + uint64_t(repeat));
    settings.mis = mis;
    const RenderResult r = renderScene(named.scene, camera, probe, strategy, settings);
    EXPECT_EQ(r.invalid.total(), 0u);
    const Image image = r.film.mean();
    for (int ty = 0; ty < tiles; ++ty)
      for (int tx = 0; tx < tiles; ++tx) {
        glm::dvec3 sum(0);
        for (int i = 0; i < kTile * kTile; ++i)
          sum += glm::dvec3(image.rgb(tx * kTile + i % kTile, ty * kTile + i / kTile));
        for (int c = 0; c < 3; ++c) means[size_t((ty * tiles + tx) * 3 + c)].push_back(sum[c]);
      }
  }
  return means;
}

// The table agrees with what each strategy says of itself, for a probe that has a sun.
TEST(Strategies, TheTableKnowsWhichAreUnbiased) {
  Image map = constantProbe({128, 64}, Rgb(0.2f));
  map.setRgb(30, 20, Rgb(50'000));
  const Probe probe(map);
  for (const LightingMethod& method : lightingMethods()) {
    const auto strategy =
        method.makeStrategy(probe, StrategyOptions{}, std::max(method.counts.min, 2));
    EXPECT_EQ(strategy->unbiased(), method.isUnbiased) << method.name;
    EXPECT_NE(strategyTable().find(fmt::format("| `{}", method.name)), std::string::npos);
  }
}

TEST(SlowStrategies, allUnbiasedOnesRenderTheSameImage) {
  struct Choice {
    const char* strategy;
    Mis mis;
  };
  // The reference strategy is "bsdf", which has no light samples and so does not depend on MIS.
  const Choice choices[] = {{"uniform", Mis::Balance},
                            {"uniform", Mis::Off},
                            {"importance", Mis::Balance},
                            {"importance", Mis::Power},
                            {"importance", Mis::Off},
                            {"product", Mis::Balance},
                            {"product", Mis::Off},
                            {"kollig-keller-strata:16", Mis::Balance},
                            {"kollig-keller-strata:16", Mis::Off}};
  const std::vector<NamedScene> scenes = threeScenes();
  const int comparisons = int(scenes.size() * std::size(choices));
  for (const NamedScene& named : scenes) {
    const auto expected = tileMeans(named, "bsdf", Mis::Balance, 1000);
    uint64_t seed = 2000;
    for (const Choice& choice : choices) {
      const auto means = tileMeans(named, choice.strategy, choice.mis, seed += 1000);
      const double significance = sidak(1e-3, comparisons * int(means.size()));
      for (size_t i = 0; i < means.size(); ++i) {
        const Moments a = Moments::of(means[i]), b = Moments::of(expected[i]);
        EXPECT_GT(welchTest(a, b), significance)
            << named.name << ", " << choice.strategy << ", mis " << int(choice.mis)
            << ", tile and channel " << i << ": " << a.mean << " and " << b.mean;
      }
    }
  }
}

}  // namespace
}  // namespace chromeball::strategies_test
