// SPDX-License-Identifier: Apache-2.0
// Guided bounces towards caustics: their density, the photons that they are learned from, unbiased
// renders with less variance.
#include "guiding/caustic_guide.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "composite/render_composite.h"
#include "lighting/polygon_lights.h"
#include "lighting/scene_sources.h"
#include "lighting/suns.h"
#include "measure/statistics.h"
#include "probe/synth.h"
#include "render/guide_training.h"
#include "small_scenes.h"
#include "sphere_test.h"
#include "test_probes.h"
#include "transport/trace_photons.h"

namespace chromeball::caustic_guide_test {
namespace {

const vec3 kUp(0, 1, 0);

// Photons on the floor around (x, z) = center, from a point light at each of the images.
std::vector<Photon> fromImages(const std::vector<vec3>& images, size_t count, float size,
                               const vec3& center = {}) {
  std::vector<Photon> photons;
  for (size_t i = 0; i < count; ++i) {
    const int n = int(i);
    const vec3 position = center + size * vec3(random1(n, 0) - 0.5f, 0, random1(n, 1) - 0.5f);
    const size_t image = i % images.size();
    const vec3 emission = unitVector(0.7f - 1.4f * float(image) / float(images.size()), 0.3f);
    photons.push_back({position, kUp, glm::normalize(images[image] - position), emission,
                       uint32_t(image), 1 + float(image)});
  }
  return photons;
}

TEST(CausticLobes, SampleTheirDensity) {
  std::vector<Photon> photons = fromImages({{1, 1, 0}, {-2, 0.5f, 1}, {0, 3, 0.3f}}, 300, 0.4f);
  // The photons are blurred, so that the test can integrate the density.
  for (size_t i = 0; i < photons.size(); ++i) {
    const vec3 offset(random1(int(i), 2), random1(int(i), 3), random1(int(i), 4));
    photons[i].direction = glm::normalize(photons[i].direction + 0.5f * offset);
  }
  const CausticLobes lobes{photons};
  EXPECT_GE(lobes.count(), 3u);
  for (const vec3& position : {vec3(0), vec3(0.2f, 0, -0.1f), vec3(3, 1, 2)}) {
    const auto draw = [&](int i) -> std::optional<vec3> {
      const auto s = lobes.sample(position, random2(i, 5), random1(i, 7));
      EXPECT_NEAR(glm::length(s.direction), 1, 1e-5f);
      EXPECT_FLOAT_EQ(s.pdf, lobes.pdf(position, s.direction));
      return s.direction;
    };
    const SphereTest test = testDirections(
        draw, [&](const vec3& w) { return double(lobes.pdf(position, w)); }, 200'000, 4);
    EXPECT_NEAR(test.totalProbability, 1, 2e-3);
    EXPECT_GT(test.chiSquare.pValue, sidak(1e-3, 3));
  }
}

// The directions to an image 0.6 m away turn by 20 degrees within the region; a lobe with this
// density at its axis, 1 / (2 pi spread), has a spread of 3.6 degrees at most.
TEST(CausticLobes, FollowAnImage) {
  const vec3 image(0.3f, 0.5f, 0.1f);
  std::vector<Photon> photons = fromImages({image}, 200, 0.2f);
  const CausticLobes lobes{photons};
  for (int i = 0; i < 50; ++i) {
    const vec3 position(0.2f * random1(i, 8) - 0.1f, 0, 0.2f * random1(i, 9) - 0.1f);
    EXPECT_GT(lobes.pdf(position, glm::normalize(image - position)), 80);
  }
}

TEST(CausticGuide, HasRegionsWhereThereArePhotons) {
  EXPECT_TRUE(CausticGuide().empty());
  EXPECT_TRUE(CausticGuide(std::vector<Photon>()).empty());
  const CausticGuide guide(fromImages({{0, 1, 0}, {1, 1, 1}}, 20'000, 2));
  EXPECT_FALSE(guide.empty());
  ASSERT_NE(guide.find({0.1f, 0, 0.2f}, kUp), nullptr);
  EXPECT_EQ(guide.find({0.1f, 0, 0.2f}, -kUp), nullptr);
  EXPECT_NE(guide.find({0.1f, 0, 0.2f}, kUp), guide.find({-0.9f, 0, 0.2f}, kUp));
}

TEST(CausticGuide, BearsExtremePhotons) {
  std::vector<Photon> photons = fromImages({{0, 1, 0}}, 2000, 1, {1e10f, 0, -1e10f});
  for (size_t i = 0; i < photons.size(); ++i) photons[i].flux = i % 2 ? 1e-30f : 1e30f;
  for (const float size : {0.0f, 1e-8f}) {
    std::vector<Photon> some = fromImages({{0, 1, 0}}, 1000, size);
    photons.insert(photons.end(), some.begin(), some.end());
  }
  const CausticGuide guide(photons);
  for (const Photon& p : photons) {
    const CausticLobes* lobes = guide.find(p.position, p.normal);
    ASSERT_NE(lobes, nullptr);
    const auto s = lobes->sample(p.position, {0.3f, 0.6f}, 0.5f);
    EXPECT_TRUE(std::isfinite(s.pdf) && s.pdf > 0) << s.pdf;
    EXPECT_NEAR(glm::length(s.direction), 1, 1e-4f);
    EXPECT_TRUE(std::isfinite(lobes->pdf(p.position, -p.direction)));
  }
}

std::vector<Photon> photonsOf(const Scene& scene, const Probe& probe, size_t count) {
  const World world(scene, {}, allTables());
  return tracePhotons(world, *makeStrategy("importance", probe, Mis::Balance, "test"), {count}, 1);
}

// All light that a mirror of area A and reflectance R receives from a small source of irradiance E
// at an angle theta arrives on the floor: E A R cos(theta).
TEST(Photons, CarryTheFluxOfAMirror) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {-20, 0, 20}, {40, 0, 0}, {0, 0, -40});
  Material mirror;
  mirror.baseColor = vec4(vec3(0.8f), 1);
  mirror.roughness = 0;
  addQuad(scene, addMaterial(scene, mirror), {0, 4, -1}, {0, 0, 2}, {-0.6f, -0.8f, 0});
  const dvec2 uv = directionToUv(Mapping::LatLong, glm::normalize(dvec3(1, 0.4, 0)));
  const Probe probe(spot(256, 128, int(uv.x * 256), int(uv.y * 128), 100, 0));
  double weighted = 0;
  vec3 light(0);
  double irradiance = 0;
  for (int i = 0; i < 1000; ++i) {  // the light's direction and irradiance, by its own samples
    const glm::uvec2 bits(uint32_t(hash(i, 1)), uint32_t(hash(i, 2)));
    DirectionSample s{};
    makeStrategy("importance", probe, Mis::Balance, "test")
        ->sampleMany(std::span(&bits, 1), std::span(&s, 1));
    light += s.wi / 1000.0f;
    irradiance += luminance(s.irradiance) / 1000.0;
  }
  const vec3 normal = glm::normalize(glm::cross(vec3(0, 0, 2), vec3(-0.6f, -0.8f, 0)));
  for (const Photon& p : photonsOf(scene, probe, 100'000)) {
    weighted += double(p.flux) / 100'000;
    EXPECT_NEAR(glm::dot(p.emission, glm::normalize(light)), 1, 1e-3f);
    EXPECT_NEAR(glm::dot(glm::normalize(p.emission - p.direction), normal), 1, 1e-3f)
        << "not a reflection";
    EXPECT_NEAR(p.position.y, 0, 1e-4f);
  }
  EXPECT_NEAR(weighted / (irradiance * 2 * 0.8 * std::fabs(double(glm::dot(normal, light)))), 1,
              0.02);
}

TEST(Photons, NeedNarrowLobes) {
  const NamedScene matte = std::move(threeScenes()[0]);
  EXPECT_TRUE(photonsOf(matte.scene, Probe(matte.probe), 10'000).empty());
  const NamedScene mirror = std::move(threeScenes()[2]);
  EXPECT_FALSE(photonsOf(mirror.scene, Probe(mirror.probe), 10'000).empty());
  const NamedScene metals = std::move(threeScenes()[1]);
  EXPECT_TRUE(photonsOf(metals.scene, Probe(constantProbe({8, 4}, Rgb(0))), 10'000).empty());
}

// All light of a lamp in a clear glass ball arrives on a floor that is very large: half of its flux
// pi A L, except for what the floor's edge misses.
TEST(Photons, LeaveLampsBehindGlass) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(0))), {-200, 0, 200}, {400, 0, 0}, {0, 0, -400});
  Material glass;
  glass.metallic = 0;
  glass.roughness = 0;
  glass.extended = ExtendedMaterial();
  glass.extended->transmission = 1;
  addSphere(scene, addMaterial(scene, glass), {0, 1, 0}, 0.5f, 64);
  Material lamp = lambert(Rgb(0));
  lamp.emission = {4, 4, 4};
  addSphere(scene, addMaterial(scene, lamp), {0, 1, 0}, 0.05f, 32);
  const std::vector<Photon> photons =
      photonsOf(scene, Probe(constantProbe({8, 4}, Rgb(0))), 100'000);
  double flux = 0;
  for (const Photon& p : photons) flux += double(p.flux) / 100'000;
  const double area = 4 * kPiD * 0.05 * 0.05;
  EXPECT_NEAR(flux / (kPiD * area * 4 / 2), 1, 0.05);
}

// A mirror, a glossy metal and a glass ball on a floor, under a lamp of a few degrees.
Scene balls(float floor = 0.5f) {
  Scene s;
  addQuad(s, addMaterial(s, lambert(Rgb(floor))), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
  Material mirror;
  mirror.roughness = 0;
  addSphere(s, addMaterial(s, mirror), {-0.8f, 0.5f, 0}, 0.5f, 32);
  Material gold;
  gold.baseColor = {1, 0.8f, 0.4f, 1};
  gold.roughness = 0.2f;
  addSphere(s, addMaterial(s, gold), {0.7f, 0.5f, 0.2f}, 0.5f, 32);
  Material glass;
  glass.metallic = 0;
  glass.roughness = 0;
  glass.extended = ExtendedMaterial();
  glass.extended->transmission = 1;
  addSphere(s, addMaterial(s, glass), {0, 0.3f, 0.9f}, 0.3f, 32);
  return s;
}

Camera above() { return Camera::lookAt({0.5f, 3, 4}, {0, 0.3f, 0}, kUp, glm::radians(35.0f)); }

Probe lamp() {
  Image image = gradientProbe({64, 32}, Rgb(0.3f, 0.4f, 0.5f), {0.2, 0.7, 0.3});
  for (int y = 7; y < 9; ++y)
    for (int x = 13; x < 15; ++x) image.setRgb(x, y, Rgb(60, 50, 40));
  return Probe(image);
}

RenderSettings guidedRender(int width, int height, uint32_t samples, Guiding guiding,
                            uint64_t seed = 0) {
  RenderSettings settings = smallRender(width, height, samples, 5, seed);
  settings.guiding = guiding;
  return settings;
}

TEST(SlowCausticGuide, AgreesWithTheUnguidedRender) {
  constexpr int kSeeds = 24, kSize = 32;
  const Scene scene = balls();
  const Probe probe = lamp();
  std::vector<std::vector<double>> tiles[2];
  std::vector<double> means[2];
  for (auto& some : tiles) some.resize(16);
  for (uint64_t seed = 0; seed < 2 * kSeeds; ++seed) {
    RenderSettings settings =
        guidedRender(kSize, kSize, 64, seed % 2 ? Guiding::On : Guiding::Off, seed);
    settings.adaptive = seed % 4 < 2;
    const RenderResult r = renderScene(scene, above(), probe, "importance", settings);
    EXPECT_EQ(r.causticFraction > 0, seed % 2 == 1);
    EXPECT_EQ(r.invalid.total(), 0u);
    const Image mean = r.film.mean();
    means[seed % 2].push_back(luminance(meanColor(mean)));
    for (int t = 0; t < 16; ++t) {
      double sum = 0;
      for (int i = 0; i < 64; ++i) sum += luminance(mean.rgb(t % 4 * 8 + i % 8, t / 4 * 8 + i / 8));
      tiles[seed % 2][size_t(t)].push_back(sum);
    }
  }
  for (size_t t = 0; t < 16; ++t)
    EXPECT_GT(welchTest(Moments::of(tiles[0][t]), Moments::of(tiles[1][t])), sidak(1e-3, 17)) << t;
  EXPECT_GT(welchTest(Moments::of(means[0]), Moments::of(means[1])), sidak(1e-3, 17));
}

// Every surface reflects all light: radiance 1 everywhere. Glass and metals converge to it slowly,
// because a few paths are cut at the depth limit.
TEST(CausticGuide, LeavesTheFurnaceWhite) {
  Scene scene = balls(1);
  for (Material& m : scene.materials) m.baseColor = vec4(1);
  const Probe probe(constantProbe({16, 8}, Rgb(1)));
  RenderSettings settings = guidedRender(40, 30, 64, Guiding::On);
  settings.maxDepth = 100;
  const RenderResult r = renderScene(scene, above(), probe, "importance", settings);
  EXPECT_GT(r.causticFraction, 0);
  const Moments pixels = Moments::of(r.film.errors().luminances);
  EXPECT_NEAR(pixels.mean, 1, 2e-3);
}

// A white ball that refracts 0.8 and scatters 0.2 of the light: some paths stay inside for tens of
// bounces. If each that the guide does not choose raised their weight, light would be missing from
// the image far beyond its stated error, and a few samples would have it all.
TEST(SlowCausticGuide, LongPathsKeepTheirWeight) {
  Scene scene;
  Material ball;
  ball.metallic = 0;
  ball.roughness = 0;
  ball.extended = ExtendedMaterial();
  ball.extended->transmission = 0.8f;
  ball.extended->thinWalled = false;
  addSphere(scene, addMaterial(scene, ball), vec3(0), 1, 96);
  const Camera camera = Camera::lookAt({0, 0, 3}, vec3(0), kUp, glm::radians(30.0f));
  const Probe probe(constantProbe({16, 8}, Rgb(1)));
  constexpr int kSeeds = 6;
  double sum = 0;  // of squared errors, over the squares of the stated ones
  for (uint64_t seed = 0; seed < kSeeds; ++seed) {
    RenderSettings settings = guidedRender(8, 8, 1024, Guiding::On, seed);
    settings.adaptive = false;
    const RenderResult r = renderScene(scene, camera, probe, "importance", settings);
    EXPECT_GT(r.causticFraction, 0);
    const PixelErrors errors = r.film.errors();
    double squared = 0;
    for (const glm::dvec4& error : squaredStandardErrors(errors)) squared += error.w / (64 * 64);
    const double error = Moments::of(errors.luminances).mean - 1;
    sum += error * error / squared;
    EXPECT_LT(squared, 0.01 * 0.01);
  }
  EXPECT_LT(sum / kSeeds, 5);
}

double relMse(const Image& a, const Image& reference) {
  double sum = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const double truth = luminance(reference.rgb(x, y));
      const double error = luminance(a.rgb(x, y)) - truth;
      sum += error * error / (truth * truth + 0.01);
    }
  return sum / (a.width * a.height);
}

// Sums over four seeds of relMSE at 128 samples, unguided and guided.
struct Errors {
  double unguided = 0, guided = 0;
};
Errors errorsOf(const Scene& scene, const Probe& probe, Guiding guiding, uint64_t seeds = 4) {
  const auto rendered = [&](uint32_t samples, Guiding guided, uint64_t seed) {
    const RenderResult r = renderScene(scene, above(), probe, "importance",
                                       guidedRender(60, 45, samples, guided, seed));
    EXPECT_EQ(r.causticFraction > 0, guided != Guiding::Off);
    return r.film.mean();
  };
  const Image reference = rendered(2048, Guiding::On, 99);
  Errors errors;
  for (uint64_t seed = 0; seed < seeds; ++seed) {
    errors.unguided += relMse(rendered(128, Guiding::Off, seed), reference);
    errors.guided += relMse(rendered(128, guiding, seed), reference);
  }
  return errors;
}

// The images are small, so there are few photons.
TEST(SlowCausticGuide, ReducesTheVariance) {
  const Errors errors = errorsOf(balls(), lamp(), Guiding::Auto);
  EXPECT_LT(errors.guided, errors.unguided / 1.6);
}

// The errors are mostly of few pixels: the gain is 1.4 over 32 seeds.
TEST(SlowCausticGuide, FindsALampBehindGlass) {
  Scene scene = balls();
  Material bulb = lambert(Rgb(0));
  bulb.emission = {300, 250, 200};
  addSphere(scene, addMaterial(scene, bulb), {0, 0.3f, 0.9f}, 0.03f, 16);
  const Errors errors = errorsOf(scene, Probe(constantProbe({8, 4}, Rgb(0.05f))), Guiding::On, 8);
  EXPECT_LT(errors.guided, errors.unguided / 1.1);
}

TEST(CausticGuide, TheNumberOfThreadsChangesNothing) {
  const Scene scene = balls();
  std::vector<Image> images;
  for (const size_t threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    const RenderResult r =
        renderScene(scene, above(), lamp(), "importance", guidedRender(70, 56, 32, Guiding::Auto));
    EXPECT_GT(r.causticFraction, 0);
    images.push_back(r.film.mean());
  }
  EXPECT_EQ(images[0].texels, images[1].texels);
  EXPECT_EQ(images[0].texels, images[2].texels);
}

// The image is proportional to the probe: only roundings differ.
TEST(CausticGuide, BearsProbesOfAnyScale) {
  const auto mean = [](float scale) {
    const RenderResult r = renderScene(balls(), above(), Probe(constantProbe({8, 4}, Rgb(scale))),
                                       "importance", guidedRender(40, 30, 32, Guiding::On));
    EXPECT_EQ(r.invalid.total(), 0u);
    EXPECT_GT(r.causticFraction, 0);
    return double(luminance(meanColor(r.film.mean()))) / double(scale);
  };
  const double usual = mean(1);
  for (const float scale : {0x1p-60f, 1e-8f, 1e10f, 0x1p60f})
    EXPECT_NEAR(mean(scale) / usual, 1, 1e-3) << scale;
}

// A probe of radiance 1 with a polygon of 20, as sources of their own.
struct DividedProbe {
  SphericalPolygon polygon{{glm::normalize(dvec3(1, 2, 0)), glm::normalize(dvec3(1, 2, 1)),
                            glm::normalize(dvec3(0, 2, 1))},
                           "test"};
  std::unique_ptr<const Probe> rest;
  std::unique_ptr<const LightSource> lighting;
  double radiance;

  DividedProbe() {
    const ImageSize size{64, 32};
    Image map = constantProbe(size, Rgb(1));
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        if (polygon.contains(texelDirection(size, x, y))) map.setRgb(x, y, Rgb(20));
    const PolygonExtraction extraction = extractPolygons(map, {polygon});
    radiance = extraction.sources[0].radiance.x;
    rest = std::make_unique<const Probe>(extraction.remainder);
    std::vector<std::unique_ptr<LightSource>> parts;
    parts.push_back(makeStrategy("importance", *rest, Mis::Off, "test"));
    parts.push_back(std::make_unique<PolygonLights>(
        std::vector<PolygonLight>{{extraction.sources[0], true, "source"}},
        constantProbe({2, 1}, Rgb(0)), Rotation()));
    lighting = std::make_unique<CombinedLight>(std::move(parts));
  }
};

// Bounces of light groups, and of sources that are polygons of the probe, follow photons too.
TEST(CausticGuide, ServesLightGroupsAndPolygons) {
  const Scene scene = balls();
  const World world(scene, {}, allTables());
  const std::atomic<bool> stop = false;
  const auto fractionUnder = [&](const LightSource& lighting, bool groups) {
    RenderSettings settings = guidedRender(40, 30, 32, Guiding::On);
    settings.lightGroups = groups;
    return render(
               world, above(), lighting, settings, [](double) {}, stop)
        .causticFraction;
  };
  const Probe probe = lamp();
  const SplitProbe split(makeStrategy("importance", probe, Mis::Balance, "test"), probe);
  EXPECT_GT(fractionUnder(split, true), 0);
  EXPECT_GT(fractionUnder(*DividedProbe().lighting, false), 0);
}

// All light of all parts.
TEST(Photons, StartFromPolygonsToo) {
  const DividedProbe probe;
  double sum = 0;
  constexpr uint32_t kCount = 200'000;
  for (uint32_t i = 0; i < kCount; ++i) {
    DirectionSample sample{};
    ASSERT_TRUE(probe.lighting->sampleDistant(
        {uint32_t(hash(i, uint64_t(1))), uint32_t(hash(i, uint64_t(2)))}, sample));
    sum += double(sample.irradiance.x) / kCount;
  }
  EXPECT_NEAR(sum / (4 * kPiD + probe.radiance * probe.polygon.solidAngle()), 1, 0.05);
}

TEST(SlowCausticGuide, CompositesAgreeWithTwoUnguidedPasses) {
  constexpr int kSeeds = 24, kSize = 24;
  const Scene scene = balls();
  const World world(scene, rayMasks({false, true, true, true}), allTables());
  const Probe probe = lamp();
  const auto lighting = makeStrategy("importance", probe, Mis::Balance, "test");
  const Image plate = constantProbe({kSize, kSize}, Rgb(0.2f));
  const std::atomic<bool> stop = false;
  std::vector<std::vector<double>> tiles[2];
  for (auto& some : tiles) some.resize(9);
  for (uint64_t seed = 0; seed < 2 * kSeeds; ++seed) {
    const bool guided = seed % 2;
    const CompositeRender r = renderComposite(
        world, above(), *lighting, plate,
        guidedRender(kSize, kSize, 64, guided ? Guiding::On : Guiding::Off, seed),
        guided ? Passes::One : Passes::Two, true, [](double) {}, stop);
    EXPECT_EQ(r.result.causticFraction > 0, guided);
    for (int t = 0; t < 9; ++t) {
      double sum = 0;
      for (int i = 0; i < 64; ++i)
        sum += luminance(r.mean.rgb(t % 3 * 8 + i % 8, t / 3 * 8 + i / 8));
      tiles[guided][size_t(t)].push_back(sum);
    }
  }
  for (size_t t = 0; t < 9; ++t)
    EXPECT_GT(welchTest(Moments::of(tiles[0][t]), Moments::of(tiles[1][t])), sidak(1e-3, 9)) << t;
}

// Light that the lobes find 100 times as often as the BSDF: guided, unless it is a small part of
// the variance.
TEST(CausticGuide, IsUsedWhereItPays) {
  const TileGrid tiles{16, 16};
  std::vector<GuideRecords> records(1);
  for (int i = 0; i < 1000; ++i)
    records[0].bounces.push_back({1, 100, 1, CausticGuide::kTrainingFraction});
  const auto fraction = [&](double variance, bool always) {
    const std::vector<double> luminances(256, 1);
    // In units of the records' part: sum of 1 over 1000 records / 16^2 samples.
    const std::vector<glm::dvec4> errors(256, glm::dvec4(variance * 1000 / 256 / 256));
    return bestFraction(records, 1, tiles, {16, 16, luminances, errors, errors}, 16, always);
  };
  EXPECT_GT(fraction(2, false), 0);
  EXPECT_EQ(fraction(1000, false), 0);
  EXPECT_GT(fraction(1000, true), 0);
}

}  // namespace
}  // namespace chromeball::caustic_guide_test
