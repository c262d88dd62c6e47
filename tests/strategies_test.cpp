// Every unbiased strategy, with every kind of multiple importance sampling, gives the same picture:
// Welch's t-test over independent seeds on each part of it, Sidak-corrected.
#include <gtest/gtest.h>

#include "measure/statistics.h"
#include "probe/synth.h"
#include "test_scene.h"

namespace chromeball {
namespace {

constexpr int kSize = 32, kTile = 8, kRepeats = 12;

struct Named {
  const char* name;
  Scene scene;
  Image probe;
};

std::vector<Named> threeScenes() {
  std::vector<Named> scenes(3);
  {
    scenes[0].name = "matte spheres on a plane under a gradient with a lamp";
    Scene& s = scenes[0].scene;
    addQuad(s, addMaterial(s, lambert({0.7f, 0.6f, 0.5f})), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
    addSphere(s, addMaterial(s, lambert({0.8f, 0.2f, 0.2f})), {-0.7f, 0.6f, 0}, 0.6f, 16);
    addSphere(s, addMaterial(s, lambert({0.2f, 0.3f, 0.8f})), {0.8f, 0.5f, 0.3f}, 0.5f, 16, false);
    scenes[0].probe = gradientProbe({32, 16}, Rgb(0.3f, 0.4f, 0.5f), {0.2, 0.7, 0.3});
    for (int x = 8; x < 12; ++x) scenes[0].probe.setRgb(x, 3, Rgb(20, 15, 10));
  }
  {
    scenes[1].name = "metals and plastics in a studio";
    Scene& s = scenes[1].scene;
    addQuad(s, addMaterial(s, lambert(Rgb(0.5f))), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
    Material gold;
    gold.baseColor = {1, 0.8f, 0.4f, 1};
    gold.roughness = 0.3f;
    addSphere(s, addMaterial(s, gold), {-0.7f, 0.6f, 0}, 0.6f, 24);
    Material plastic;
    plastic.baseColor = {0.1f, 0.5f, 0.2f, 1};
    plastic.metallic = 0;
    plastic.roughness = 0.5f;
    addSphere(s, addMaterial(s, plastic), {0.8f, 0.6f, 0.3f}, 0.6f, 24);
    scenes[1].probe = studioProbe({64, 32});
  }
  {
    scenes[2].name = "a lamp, a mirror and a veil";
    Scene& s = scenes[2].scene;
    addQuad(s, addMaterial(s, lambert(Rgb(0.6f))), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
    Material mirror;
    mirror.roughness = 0;
    addSphere(s, addMaterial(s, mirror), {-0.7f, 0.6f, 0}, 0.6f, 24);
    Material lamp = lambert(Rgb(0.2f));
    lamp.emission = {4, 3, 2};
    addSphere(s, addMaterial(s, lamp), {0.9f, 1.4f, 0}, 0.5f, 12);
    Material veil = lambert({0.9f, 0.4f, 0.4f});
    veil.alphaMode = AlphaMode::Blend;
    veil.baseColor.w = 0.4f;
    addQuad(s, addMaterial(s, veil), {0.2f, 0, 1}, {1.2f, 0, 0}, {0, 1, 0});
    scenes[2].probe = overcastProbe({32, 16}, Rgb(0.5f), 0.2);
  }
  return scenes;
}

// Tile means, for each repeat: [tile and channel][repeat].
std::vector<std::vector<double>> tileMeans(const Named& named, const char* strategy, Mis mis,
                                           uint64_t firstSeed) {
  const int tiles = kSize / kTile;
  std::vector<std::vector<double>> means(size_t(tiles * tiles * 3));
  const Camera camera = Camera::lookAt({0.5f, 2.5f, 4}, {0, 0.5f, 0}, {0, 1, 0}, 0.7f);
  const Probe probe(named.probe, 25);
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    RenderSettings settings = smallRender(kSize, kSize, 64, 6, firstSeed + uint64_t(repeat));
    settings.mis = mis;
    const RenderResult r = renderScene(named.scene, camera, probe, strategy, settings);
    EXPECT_EQ(r.invalid.count, 0u);
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

TEST(SlowStrategies, allUnbiasedOnesGiveTheSamePicture) {
  struct Choice {
    const char* strategy;
    Mis mis;
  };
  // "bsdf" takes no light samples, so MIS cannot change it; it is what all others are held to.
  const Choice choices[] = {{"uniform", Mis::Balance},
                            {"uniform", Mis::Off},
                            {"importance", Mis::Balance},
                            {"importance", Mis::Power},
                            {"importance", Mis::Off},
                            {"product", Mis::Balance},
                            {"product", Mis::Off},
                            {"kollig-keller-strata:16", Mis::Balance},
                            {"kollig-keller-strata:16", Mis::Off}};
  const std::vector<Named> scenes = threeScenes();
  const int comparisons = int(scenes.size() * std::size(choices));
  for (const Named& named : scenes) {
    const auto expected = tileMeans(named, "bsdf", Mis::Balance, 1000);
    uint64_t seed = 2000;
    for (const Choice& choice : choices) {
      const auto means = tileMeans(named, choice.strategy, choice.mis, seed += 1000);
      const double significance = sidak(1e-3, comparisons * int(means.size()));
      for (size_t i = 0; i < means.size(); ++i) {
        const Moments a = Moments::of(means[i]), b = Moments::of(expected[i]);
        EXPECT_GT(welchTest(a, b), significance)
            << named.name << ", " << choice.strategy << ", mis " << int(choice.mis) << ", part "
            << i << ": " << a.mean << " and " << b.mean;
      }
    }
  }
}

// `noise` claims the standard error of each pixel: held to the spread over independent seeds.
TEST(SlowStrategies, theNoiseReportedIsTheNoiseThereIs) {
  for (const Named& named : threeScenes()) {
    SCOPED_TRACE(named.name);
    const Camera camera = Camera::lookAt({0.5f, 2.5f, 4}, {0, 0.5f, 0}, {0, 1, 0}, 0.7f);
    const Probe probe(named.probe, 25);
    constexpr int kSeeds = 32;
    std::vector<glm::dvec2> sums(kSize * kSize);
    double reported = 0, meanLuminance = 0;
    for (int seed = 0; seed < kSeeds; ++seed) {
      const RenderResult r = renderScene(named.scene, camera, probe, "importance",
                                         smallRender(kSize, kSize, 64, 6, uint64_t(seed)));
      reported += r.film.noise() / kSeeds;
      const Image image = r.film.mean();
      for (int i = 0; i < kSize * kSize; ++i) {
        const double y = luminance(image.rgb(i % kSize, i / kSize));
        sums[size_t(i)] += glm::dvec2(y, y * y);
        meanLuminance += y / (kSeeds * kSize * kSize);
      }
    }
    double spread = 0;
    for (const glm::dvec2& s : sums) {
      const double mean = s.x / kSeeds;
      const double variance = std::max(0.0, (s.y - s.x * mean) / (kSeeds - 1));
      spread += std::sqrt(variance) / std::max(mean, 0.01 * meanLuminance) / (kSize * kSize);
    }
    EXPECT_NEAR(reported / spread, 1, 0.1);
  }
}

}  // namespace
}  // namespace chromeball
