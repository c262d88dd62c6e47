// SPDX-License-Identifier: Apache-2.0
// Rendering with directional lights instead of the probe: no light is lost or counted twice.
#include "lighting/delta_lights.h"
#include "hypothesis.h"

#include <gtest/gtest.h>

#include <optional>

#include "all_tables.h"
#include "base/error.h"
#include "lighting/fit/irradiance_fit.h"
#include "lighting/methods.h"
#include "probe/irradiance.h"
#include "probe/mapping.h"
#include "probe/synth.h"
#include "shading/bsdf.h"
#include "strategy_samples.h"
#include "test_scene.h"

namespace chromeball::delta_lights_test {
namespace {

Scene mattePlane(const Rgb& albedo) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(albedo)), {-10, 0, 10}, {20, 0, 0}, {0, 0, -20});
  return scene;
}

void expectNear(const Rgb& a, const dvec3& b, double relative) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], relative * b[c]);
}

// Mean over random numbers of the sum over light samples of f(wi) x irradiance at `point`.
template <class F>
dvec3 meanEstimate(const LightSource& lighting, const LightPoint& point, uint64_t seed, F f,
                   uint32_t count = 1024) {
  const SobolTable table(count, dimension::kVertex + 2 * dimension::kPerVertex, seed);
  PixelSampler sampler(table, seed);
  sampler.startPixel(3, 5, 0);
  dvec3 sum(0);
  for (uint32_t i = 0; i < count; ++i) {
    sampler.startSample(i);
    sampler.startVertex(point.depth);
    std::vector<DirectionSample> samples;
    lighting.sample(point, sampler, samples);
    for (const DirectionSample& s : samples) sum += dvec3(s.irradiance) * double(f(s.wi));
  }
  return sum / double(count);
}

TEST(DeltaLights, aMattePlaneHasTheIrradianceOfTheLights) {
  const Image map = studioProbe({64, 32});
  const Rgb albedo(0.8f, 0.5f, 0.2f);
  dvec3 irradiance(0);
  for (const DirectionalLight& light : makeLights("median-cut", map, {.count = 16}).lights)
    irradiance += dvec3(light.irradiance) * double(std::max(light.direction.y, 0.0f));
  const RenderResult r = renderScene(mattePlane(albedo), topCamera(3, 40), Probe(map),
                                     "median-cut:16", smallRender(4, 4, 4, 1));
  expectNear(meanColor(r.film.mean()), irradiance * dvec3(albedo) / kPiD, 1e-5);
}

TEST(SlowDeltaLights, fittedLightsGiveTheExactIrradianceWithinTheErrorOfTheFit) {
  const Image map = studioProbe({64, 32});
  const vec3 up[] = {{0, 1, 0}};
  const dvec3 exact = exactIrradiance(map, up).front();
  const dvec3 mean = kPiD * meanRadiance(map);  // irradiance, over all orientations
  for (const bool ambient : {false, true}) {
    const IrradianceFit fit = fitIrradiance(map, {.count = 16, .ambient = ambient});
    ASSERT_LT(fit.maxError, 20);
    const RenderResult r = renderScene(mattePlane(Rgb(1)), topCamera(3, 40), Probe(map),
                                       ambient ? "irradiance-fit-ambient:16" : "irradiance-fit:16",
                                       smallRender(4, 4, 64, 1));
    const dvec3 error = kPiD * dvec3(meanColor(r.film.mean())) - exact;
    EXPECT_LT(std::fabs(error.x) + std::fabs(error.y) + std::fabs(error.z),
              (mean.x + mean.y + mean.z) * (fit.maxError / 100 + 1e-3));
  }
}

TEST(DeltaLights, ambientLightReachesEveryPointOfAPlane) {
  const Probe probe(constantProbe({8, 4}, Rgb(100)));
  const DeltaLights lighting(probe, {{glm::normalize(vec3(1, 1, 0)), Rgb(2, 0, 1)}},
                             Rgb(0.5f, 0.25f, 0));
  const Scene scene = mattePlane(Rgb(1));
  const World world(scene);
  const std::atomic<bool> stop = false;
  for (Mis mis : {Mis::Off, Mis::Balance, Mis::Power}) {
    RenderSettings settings = smallRender(4, 4, 16, 1);
    settings.mis = mis;
    const RenderResult r = render(
        world, topCamera(3, 40), lighting, settings, [](double) {}, stop);
    const double cosine = std::sqrt(0.5);
    expectNear(meanColor(r.film.mean()), dvec3(0.5 + 2 * cosine / kPiD, 0.25, cosine / kPiD), 1e-5);
  }
}

TEST(DeltaLights, perfectMirrorsReflectTheProbeAndNoLights) {
  Scene scene;
  Material mirror;
  mirror.roughness = 0;
  addSphere(scene, addMaterial(scene, mirror), vec3(0), 1);
  const Camera camera = Camera::lookAt({1, 2, 3}, {0, 0, 0}, {0, 1, 0}, 0.7f);
  const Probe probe(studioProbe({64, 32}), 40);
  const RenderSettings settings = smallRender(16, 16, 4, 3);
  const Image expected = renderScene(scene, camera, probe, "bsdf", settings).film.mean();
  for (const char* strategy : {"median-cut:16", "irradiance-fit-ambient:2"}) {
    const Image seen = renderScene(scene, camera, probe, strategy, settings).film.mean();
    for (size_t i = 0; i < expected.texels.size(); ++i)  // compiled elsewhere: but for rounding
      EXPECT_NEAR(seen.texels[i], expected.texels[i], 1e-6f * expected.texels[i]) << strategy;
  }
}

// On a nearly perfect mirror, directional lights would show only as bright dots. Up to noise, the
// image equals the unbiased strategy's, and a mirror of albedo 1 conserves energy.
TEST(DeltaLights, nearMirrorsReflectTheProbe) {
  const Camera camera = Camera::lookAt({1, 2, 3}, {0, 0, 0}, {0, 1, 0}, 0.7f);
  const RenderSettings settings = smallRender(16, 16, 64, 3);
  for (const float roughness : {0.03f, 0.15f}) {
    Scene scene;
    Material metal;
    metal.roughness = roughness;
    addSphere(scene, addMaterial(scene, metal), vec3(0), 1);
    const Probe studio(studioProbe({64, 32}), 40);
    const Image seen = renderScene(scene, camera, studio, "median-cut:16", settings).film.mean();
    const Image expected = renderScene(scene, camera, studio, "importance", settings).film.mean();
    double difference = 0, sum = 0;
    for (size_t i = 0; i < expected.texels.size(); ++i) {
      difference += std::fabs(seen.texels[i] - expected.texels[i]);
      sum += expected.texels[i];
    }
    EXPECT_LT(difference, 0.1 * sum) << roughness;
    const Probe white(constantProbe({8, 4}, Rgb(1)));
    const Image furnace = renderScene(scene, camera, white, "median-cut:16", settings).film.mean();
    EXPECT_NEAR(meanColor(furnace).y, 1, 0.005) << roughness;
  }
}

// White furnace test with interreflection. Light that is lost or counted twice causes an error many
// times larger than the approximation error of the lights.
TEST(SlowDeltaLights, aWhiteFurnaceConservesEnergy) {
  Scene scene;
  const int white = addMaterial(scene, lambert(Rgb(1)));
  addQuad(scene, white, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
  addQuad(scene, white, {-1, 0, -1}, {2, 0, 0}, {0, 1.5f, 0});
  addQuad(scene, white, {-1, 0, 1}, {0, 0, -2}, {0, 1.5f, 0});
  Material metal;
  metal.roughness = 0.7f;
  addSphere(scene, addMaterial(scene, metal), {0.3f, 0.5f, 0}, 0.4f);
  const Camera camera = Camera::lookAt({1, 2, 4}, {0, 0.6f, 0}, {0, 1, 0}, 0.6f);
  const Probe probe(constantProbe({32, 16}, Rgb(1)));
  for (const char* strategy : {"kollig-keller:512", "cube-grid:10", "irradiance-fit-ambient:1"}) {
    const RenderResult r = renderScene(scene, camera, probe, strategy, smallRender(24, 24, 64, 64));
    EXPECT_NEAR(meanColor(r.film.mean()).y, 1, 0.015) << strategy;
  }
}

// At later hits, a few lights are chosen with a probability proportional to irradiance x cosine and
// divided by it: the estimate is unbiased.
TEST(DeltaLights, laterHitsSampleFewLightsWithoutBias) {
  const Probe probe(studioProbe({64, 32}), 70);
  const Constellation lights =
      makeLights("lightgen", probe.latLong(), {.count = 40, .seed = 1}).lights;
  const DeltaLights lighting(probe, lights);
  LightPoint point{};
  point.normal = glm::normalize(vec3(0.5f, 0.3f, -0.4f));
  const auto cosine = [&](const vec3& wi) { return std::max(glm::dot(wi, point.normal), 0.0f); };
  // An integrand with half of the lights in shadow and a lobe around a direction.
  const auto other = [&](const vec3& wi) {
    return wi.x > 0.2f ? cosine(wi) * std::pow(std::max(wi.y, 0.0f), 5.0f) : 0;
  };
  const dvec3 allCosine = meanEstimate(lighting, point, 1, cosine);
  const dvec3 allOther = meanEstimate(lighting, point, 1, other);
  std::vector<double> cosines[3], others[3];
  point.depth = 1;
  for (uint64_t seed = 10; seed < 26; ++seed)
    for (int c = 0; c < 3; ++c) {
      cosines[c].push_back(meanEstimate(lighting, point, seed, cosine)[c]);
      others[c].push_back(meanEstimate(lighting, point, seed, other)[c]);
    }
  for (int c = 0; c < 3; ++c) {
    EXPECT_GT(tTest(Moments::of(cosines[c]), allCosine[c]), sidak(1e-3, 6));
    EXPECT_GT(tTest(Moments::of(others[c]), allOther[c]), sidak(1e-3, 6));
    EXPECT_NEAR(Moments::of(cosines[c]).mean / allCosine[c], 1, 1e-2);
  }
}

// A point whose BSDF is not 0 below the shading normal: by transmission, or by a coat with another
// normal.
class ExtendedLightPoint {
 public:
  ExtendedLightPoint(float roughness, float transmission, bool thinWalled, bool coated) {
    Surface surface{};
    surface.geometricNormal = {0, 0, 1};
    surface.normal = glm::normalize(vec3(1, 0.5f, 0.8f));  // as of a bump map; the coat has none
    surface.frontFace = true;
    ExtendedPoint extended;
    extended.transmission = transmission;
    extended.thinWalled = thinWalled;
    extended.clearcoat = coated;
    extended.clearcoatRoughness = 0.6f;
    extended.clearcoatNormal = surface.geometricNormal;
    const vec3 wo = glm::normalize(vec3(0.3f, -0.2f, 1));
    const MaterialPoint tinted{Rgb(0.8f, 0.7f, 0.6f), 0, roughness, Rgb(0.04f), 1};
    bsdf_.emplace(tinted, extended, RefractiveIndex{Rgb(1.5f), 1.5f}, surface, wo, allTables());
    point_ = {vec3(0), bsdf_->normal(), &*bsdf_, 0, bsdf_->transmits()};
  }
  ExtendedLightPoint(const ExtendedLightPoint&) = delete;

  LightPoint at(int depth) const {
    LightPoint point = point_;
    point.depth = depth;
    return point;
  }
  float reflected(const vec3& wi) const { return bsdf_->evaluate(wi).fCos.y; }
  float fromBelow(const vec3& wi) const {
    return glm::dot(wi, bsdf_->normal()) > 0 ? 0 : reflected(wi);
  }

 private:
  std::optional<Bsdf> bsdf_;
  LightPoint point_;
};

// At later hits, every light with a contribution must have a probability above 0, in all
// strategies.
TEST(SlowDeltaLights, laterHitsSampleEveryContributingLight) {
  struct Case {
    const char* name;
    float roughness, transmission;
    bool thinWalled, coated;
  };
  const Probe probe(studioProbe({64, 32}), 70);
  for (const std::string_view name : strategyNames()) {
    const auto lighting = makeStrategy(std::string(name), probe, Mis::Balance, "test");
    const auto samples = Samples(*lighting, {0, 1, 0}).take(0);
    if (samples.empty() || !samples.front().isDelta) continue;  // it samples areas
    for (const Case& c : {Case{"body", 0.4f, 1, false, false},
                          {"rougher body", 0.9f, 1, false, false},
                          {"sheet", 0.5f, 1, true, false},
                          {"half body", 0.5f, 0.5f, false, false},
                          {"half sheet", 0.5f, 0.5f, true, false},
                          {"coat", 0.5f, 0, true, true},
                          {"coated body", 0.5f, 1, false, true}}) {
      const ExtendedLightPoint here(c.roughness, c.transmission, c.thinWalled, c.coated);
      const auto mean = [&](int depth, auto f) {
        return meanEstimate(*lighting, here.at(depth), 1, f, depth == 0 ? 1 : 256);
      };
      const auto reflected = [&](const vec3& wi) { return here.reflected(wi); };
      const auto fromBelow = [&](const vec3& wi) { return here.fromBelow(wi); };
      const dvec3 all = mean(0, reflected), few = mean(1, reflected);
      const dvec3 allBelow = mean(0, fromBelow), fewBelow = mean(1, fromBelow);
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(few[k] / all[k], 1, 0.02) << name << ", " << c.name;
        EXPECT_NEAR(fewBelow[k] / all[k], allBelow[k] / all[k], 0.02) << name << ", " << c.name;
      }
      // Else the comparison of light from below would be meaningless.
      EXPECT_GT(allBelow.y, 5e-4 * all.y) << name << ", " << c.name;
    }
  }
}

TEST(DeltaLights, rotateWithTheProbe) {
  Scene scene;
  addSphere(scene, addMaterial(scene, lambert(Rgb(0.8f))), vec3(0), 1, 32);
  const Image map = studioProbe({64, 32});
  const auto renderMean = [&](const vec3& eye, float rotation, const char* strategy) {
    const Camera camera = Camera::lookAt(eye, vec3(0), {0, 1, 0}, 0.6f);
    return meanColor(
        renderScene(scene, camera, Probe(map, rotation), strategy, smallRender(16, 16, 16, 1))
            .film.mean());
  };
  // Counter-clockwise seen from above, +Z goes to +X.
  for (const char* strategy : {"median-cut:16", "kollig-keller-strata:16"}) {
    const Rgb unrotated = renderMean({0, 1, 4}, 0, strategy);
    expectNear(renderMean({4, 1, 0}, 90, strategy), unrotated, 5e-3);
    EXPECT_GT(std::fabs(renderMean({4, 1, 0}, -90, strategy).y - unrotated.y), 0.05 * unrotated.y);
  }
}

TEST(DeltaLights, blackProbesGiveBlackImages) {
  const Probe probe(constantProbe({8, 4}, Rgb(0)));
  for (const char* strategy :
       {"median-cut:4", "variance-cut:4", "lightgen:4", "kollig-keller:4", "kollig-keller-strata:4",
        "cube-grid:2", "penrose:4", "irradiance-fit:2", "irradiance-fit-ambient:2"}) {
    const RenderResult r =
        renderScene(mattePlane(Rgb(1)), topCamera(3, 40), probe, strategy, smallRender(4, 4, 4, 2));
    EXPECT_EQ(r.invalid.total(), 0u) << strategy;
    EXPECT_EQ(meanColor(r.film.mean()), Rgb(0)) << strategy;
  }
}

std::string errorMessage(const std::string& name) {
  const Probe probe(constantProbe({8, 4}, Rgb(1)));
  try {
    makeStrategy(name, probe, Mis::Balance, "scene.toml:7");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(StrategyTable, rejectsBadCountsInOneLine) {
  for (const char* name : {"median-cut:1", "median-cut:4097", "median-cut:", "median-cut:x",
                           "median-cut:8x", "median-cut:-3", "median-cut:99999999999",
                           "median-cut:8:8", "cube-grid:27", "irradiance-fit:0"}) {
    const std::string message = errorMessage(name);
    EXPECT_TRUE(message.starts_with("scene.toml:7: ")) << name;
    EXPECT_NE(message.find("or no count for"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
  EXPECT_NE(errorMessage("bsdf:3").find("takes no count"), std::string::npos);
  EXPECT_NE(errorMessage("median-cud:3").find("did you mean `median-cut`"), std::string::npos);
  EXPECT_NE(errorMessage("").find("known"), std::string::npos);
}

TEST(StrategyTable, helpListsEveryStrategy) {
  const std::string help = strategyHelp(), lights = lightMethodHelp();
  for (const LightingMethod& method : lightingMethods()) {
    const std::string name = "  " + std::string(method.name);
    EXPECT_NE(help.find(name), std::string::npos) << name;
    EXPECT_EQ(lights.find(name) != std::string::npos, bool(method.lights.make)) << name;
  }
  EXPECT_NE(help.find("penrose:N"), std::string::npos);
  EXPECT_NE(help.find("(N 2 to 4096, default 300)"), std::string::npos);
}

TEST(SlowStrategyTable, resolvedNamesIncludeTheCount) {
  EXPECT_EQ(resolveStrategy("importance"), "importance");
  EXPECT_EQ(resolveStrategy("median-cut:7"), "median-cut:7");
  EXPECT_TRUE(resolveStrategy("median-cut").starts_with("median-cut:"));
  const Probe probe(gradientProbe({16, 8}, Rgb(1), {0.3, 0.5, 0}));
  for (const char* name : {"bsdf", "uniform", "importance", "kollig-keller-strata"})
    EXPECT_TRUE(makeStrategy(name, probe, Mis::Balance, "")->unbiased()) << name;
  for (const char* name : {"median-cut", "median-cut-centre", "median-cut-flat", "median-cut-area",
                           "median-cut-centre-area", "median-cut-flat-area", "median-cut-disc",
                           "variance-cut", "lightgen", "kollig-keller", "kollig-keller-average",
                           "cube-grid", "penrose", "irradiance-fit", "irradiance-fit-ambient"})
    EXPECT_FALSE(makeStrategy(name, probe, Mis::Balance, "")->unbiased()) << name;
}

}  // namespace
}  // namespace chromeball::delta_lights_test
