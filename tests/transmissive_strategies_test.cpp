// SPDX-License-Identifier: Apache-2.0
// Every strategy on every kind of transmissive surface must sample light from both sides.
#include <gtest/gtest.h>

#include "base/error.h"
#include "lighting/delta_lights.h"
#include "lighting/methods.h"
#include "measure/statistics.h"
#include "probe/synth.h"
#include "test_scene.h"

namespace chromeball::transmissive_strategies_test {
namespace {

struct NamedMaterial {
  const char* name;
  Material material;
};

Material transmissive(float roughness, bool thinWalled, float fraction = 1) {
  Material m;
  m.baseColor = {1, 0.9f, 0.8f, 1};
  m.metallic = 0;
  m.roughness = roughness;
  m.doubleSided = true;
  m.extended.emplace();
  m.extended->transmission = fraction;
  m.extended->thinWalled = thinWalled;
  return m;
}

// The rough materials have a GGX alpha above `minAlpha`.
std::vector<NamedMaterial> roughMaterials(float minAlpha) {
  const float rough = std::sqrt(minAlpha) + 0.05f;
  std::vector<NamedMaterial> all = {{"rough sheet", transmissive(rough, true)},
                                    {"rough body", transmissive(rough, false)},
                                    {"rougher body", transmissive(0.9f, false)},
                                    {"half body", transmissive(rough, false, 0.5f)},
                                    {"half sheet", transmissive(rough, true, 0.5f)},
                                    {"coated body", transmissive(rough, false)}};
  all.back().material.extended->clearcoat = 1;
  all.back().material.extended->clearcoatRoughness = rough;
  return all;
}

constexpr int kRepeats = 8;

struct View {
  Scene scene;
  Camera camera = Camera::lookAt({1, 2.5f, 3}, {0, 0.1f, 0}, {0, 1, 0}, 0.75f);

  // A ball on a small floor, which casts a shadow and transmits light onto it.
  explicit View(const Material& material) {
    addQuad(scene, addMaterial(scene, lambert({0.5f, 0.6f, 0.7f})), {-1.2f, -1.05f, 1.2f},
            {2.4f, 0, 0}, {0, 0, -2.4f});
    addSphere(scene, addMaterial(scene, material), vec3(0), 1, 16);
  }

  // The image's mean for each channel, for consecutive seeds from `firstSeed`.
  std::array<std::vector<double>, 3> means(const LightSource& lighting, Mis mis, uint64_t firstSeed,
                                           int samples = 16) const {
    const World world(scene, {}, allTables());
    const std::atomic<bool> stop = false;
    std::array<std::vector<double>, 3> all;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      RenderSettings settings = smallRender(6, 6, samples, 6, firstSeed + uint64_t(repeat));
      settings.mis = mis;
      const RenderResult r = render(
          world, camera, lighting, settings, [](double) {}, stop);
      EXPECT_EQ(r.invalid.total(), 0u);
      const Rgb mean = meanColor(r.film.mean());
      for (int c = 0; c < 3; ++c) all[size_t(c)].push_back(mean[c]);
    }
    return all;
  }
};

void expectSame(const std::array<std::vector<double>, 3>& found,
                const std::array<std::vector<double>, 3>& expected, int comparisons,
                const std::string& where) {
  for (size_t c = 0; c < 3; ++c) {
    const Moments a = Moments::of(found[c]), b = Moments::of(expected[c]);
    EXPECT_GT(welchTest(a, b), sidak(1e-3, 3 * comparisons))
        << where << ": " << a.mean << " and " << b.mean;
    EXPECT_LT(std::sqrt(b.variance / kRepeats), 0.05 * b.mean) << where;
  }
}

TEST(SlowTransmissiveStrategies, unbiasedOnesAgree) {
  const Probe probe(gradientProbe({32, 16}, Rgb(0.6f, 0.5f, 0.4f), {0.5, -0.6, 0.4}), 25);
  std::vector<NamedMaterial> all = roughMaterials(0.1f);
  all.push_back({"smooth sheet", transmissive(0, true)});
  all.push_back({"smooth body", transmissive(0, false)});
  all.push_back({"smooth body with straight shadows", transmissive(0, false)});
  all.back().material.straightShadows = true;
  struct Choice {
    std::string_view name;
    Mis mis;
    std::unique_ptr<LightSource> lighting;
  };
  std::vector<Choice> choices;
  for (const std::string_view name : strategyNames())
    for (const Mis mis : {Mis::Off, Mis::Balance})
      if (auto lighting = makeStrategy(std::string(name), probe, mis, "test"); lighting->unbiased())
        choices.push_back({name, mis, std::move(lighting)});
  EXPECT_GE(choices.size(), 2 * 6u);
  const int comparisons = int(all.size() * choices.size());
  const auto bsdf = makeStrategy("bsdf", probe, Mis::Balance, "test");
  for (const auto& [name, material] : all) {
    const View view(material);
    const auto expected = view.means(*bsdf, Mis::Balance, 1000, 64);
    uint64_t seed = 2000;
    for (const Choice& choice : choices)
      expectSame(view.means(*choice.lighting, choice.mis, seed += 100), expected, comparisons,
                 fmt::format("{}, {}, mis {}", name, choice.name, int(choice.mis)));
  }
}

// Lights that replace a probe give the same image as directional lamps under a black probe.
TEST(SlowTransmissiveStrategies, lightsThatReplaceTheProbeEqualLamps) {
  const Probe black(constantProbe({4, 2}, Rgb(0)));
  for (const int count : {5, 40}) {
    const Constellation lights =
        makeLights("lightgen", studioProbe({64, 32}), {.count = count, .seed = 1}).lights;
    const DeltaLights deltaLights(black, lights);
    const auto none = makeStrategy("bsdf", black, Mis::Balance, "test");
    for (const auto& [name, material] : roughMaterials(deltaLights.mirrorAlpha())) {
      const View view(material);
      View lit(material);
      for (const DirectionalLight& light : lights) {
        PunctualLight lamp;
        lamp.kind = PunctualLight::Kind::Directional;
        lamp.direction = -light.direction;
        lamp.intensity = light.irradiance;
        lit.scene.lights.push_back(lamp);
      }
      expectSame(view.means(deltaLights, Mis::Balance, 100),
                 lit.means(*none, Mis::Balance, 500, 64), 2 * 6,
                 fmt::format("{}, {} lights", name, count));
    }
  }
}

}  // namespace
}  // namespace chromeball::transmissive_strategies_test
