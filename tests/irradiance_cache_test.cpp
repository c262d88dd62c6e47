// SPDX-License-Identifier: Apache-2.0
// The irradiance cache: exact where the light is even, gradients against differences, its bias
// against path tracing, and its records.
#include <gtest/gtest.h>

#include "approximate/cached_integrator.h"
#include "base/archive.h"
#include "base/error.h"
#include "base/parallel.h"
#include "probe/synth.h"
#include "scene/extended_surface.h"
#include "small_scenes.h"
#include "study/study.h"

namespace chromeball::irradiance_cache_test {
namespace {

const std::atomic<bool> kNever = false;

// A scene with everything that is needed to trace it.
struct Traced {
  Scene scene;
  World world;
  Probe probe;
  std::unique_ptr<LightSource> lighting;
  PathTracer tracer;

  Traced(const Scene& given, const Image& light, const char* strategy = "importance")
      : scene(given),
        world(scene, {}, allTables()),
        probe(light),
        lighting(makeStrategy(strategy, probe, Mis::Balance, "test")),
        tracer(world, *lighting, PathSettings{.estimateDepthCut = false}) {}

  IrradianceCache fill(float error, const Camera& camera, const RenderSettings& settings) const {
    IrradianceCache cache(error);
    fillCache(
        cache, tracer, camera, {settings.width, settings.height}, settings.seed, [](double) {},
        kNever);
    return cache;
  }
};

RenderResult renderRow(const std::string& name, const Scene& scene, const Camera& camera,
                       const Image& light, const RenderSettings& settings) {
  const Row row = rowNamed(name, "test");
  const World world(scene, {}, allTables());
  const Probe probe(light);
  const auto lighting = makeStrategy(row.strategy, probe, Mis::Balance, "test");
  return render(
      world, camera, *lighting, row.applied(settings), [](double) {}, kNever);
}

// A floor with a wall at x = 1.
Scene corner() {
  Scene scene;
  const int grey = addMaterial(scene, lambert(Rgb(0.6f)));
  addQuad(scene, grey, {-4, 0, 4}, {5, 0, 0}, {0, 0, -8});
  addQuad(scene, grey, {1, 0, 4}, {0, 3, 0}, {0, 0, -8});
  return scene;
}

// A room of 4 x 3 x 4 m with a window in one wall, a red and a green wall and a block.
Scene room() {
  Scene s;
  const int white = addMaterial(s, lambert(Rgb(0.7f)));
  const int red = addMaterial(s, lambert({0.7f, 0.1f, 0.1f}));
  const int green = addMaterial(s, lambert({0.1f, 0.6f, 0.1f}));
  addQuad(s, white, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
  addQuad(s, white, {-2, 3, -2}, {4, 0, 0}, {0, 0, 4});
  addQuad(s, white, {-2, 0, -2}, {4, 0, 0}, {0, 3, 0});
  addQuad(s, red, {-2, 0, 2}, {0, 0, -4}, {0, 3, 0});
  addQuad(s, green, {2, 0, -2}, {0, 0, 4}, {0, 1, 0});  // below the window
  addQuad(s, green, {2, 2.2f, -2}, {0, 0, 4}, {0, 0.8f, 0});
  addQuad(s, white, {-2, 0, 2}, {0, 3, 0}, {4, 0, 0});
  addQuad(s, white, {-0.5f, 0.8f, 0}, {1, 0, 0}, {0, 0, -1});
  addQuad(s, white, {-0.5f, 0, 0}, {1, 0, 0}, {0, 0.8f, 0});
  return s;
}

Camera inRoom() { return Camera::lookAt({0.3f, 1.6f, 1.8f}, {-0.2f, 1, -1}, {0, 1, 0}, 1.1f); }

// One record of the floor of corner(), `height` and the normal given.
IrradianceRecord recordAt(const Traced& traced, const vec3& above, const vec3& normal,
                          float samples) {
  Hit hit;
  const Ray down{above, {0, -1, 0}};
  EXPECT_TRUE(traced.world.accel.intersect(down, 0, hit));
  const Scene& scene = traced.world.scene;
  const Surface surface =
      surfaceAt(scene, scene.instances[hit.instance], hit.triangle, hit.barycentric, {0, 1, 0});
  const HemisphereStrata strata = hemisphereStrata(samples);
  const SobolTable table(std::bit_ceil(uint32_t(strata.count())), 60, 1);
  PathContexts contexts(
      [&] { return PathContext{.sampler = PixelSampler(table, 1), .clamp = Clamp(std::nullopt)}; });
  const auto record = gatherIrradiance(traced.tracer, surface, normal, strata, {3, 4}, 1, contexts);
  EXPECT_TRUE(record);
  return record.value_or(IrradianceRecord());
}

// In a closed sphere that emits 1, what its surface reflects is sum rho^n.
TEST(IrradianceCache, IsExactWhereTheLightIsEven) {
  constexpr double kAlbedo = 0.5;
  Scene scene;
  Material material = lambert(Rgb(float(kAlbedo)));
  material.emission = Rgb(1);
  addSphere(scene, addMaterial(scene, material), {0, 0, 0}, -1, 24);
  const Camera camera = Camera::lookAt({0, 0, 0}, {1, 0.2f, 0.3f}, {0, 1, 0}, 0.6f);
  const Image black = constantProbe({16, 8}, Rgb(0));
  RenderSettings settings = smallRender(32, 32, 64, 3);
  const double expected = 1 + kAlbedo + kAlbedo * kAlbedo + kAlbedo * kAlbedo * kAlbedo;
  const auto mean = luminance(meanColor(
      renderRow("importance+irradiance-cache:0.2", scene, camera, black, settings).film.mean()));
  EXPECT_NEAR(mean, expected, 0.01 * expected);
}

TEST(IrradianceCache, AnOpenFloorIsOneRecord) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {-50, 0, 50}, {100, 0, 0}, {0, 0, -100});
  const Traced traced(scene, constantProbe({16, 8}, Rgb(1)));
  const Camera camera = Camera::lookAt({0, 2, 5}, {0, 0, 0}, {0, 1, 0}, 0.8f);
  const IrradianceCache cache = traced.fill(0.2f, camera, smallRender(320, 240, 1, 8));
  EXPECT_EQ(cache.size(), 1u);
  EXPECT_EQ(luminance(cache.records()[0].irradiance), 0);
  EXPECT_TRUE(std::isinf(cache.records()[0].radius));
}

// A single far record would miss the wall of corner().
TEST(IrradianceCache, FindsAWallBehindARecordThatSeesNothing) {
  Scene scene = corner();
  addQuad(scene, 0, {-400, 0, 4}, {390, 0, 0}, {0, 0, -8});
  const Traced traced(scene, constantProbe({16, 8}, Rgb(1)));
  const Camera camera = Camera::lookAt({-30, 20, 0}, {-15, 0, 0}, {0, 1, 0}, 1.2f);
  const IrradianceCache cache = traced.fill(0.2f, camera, smallRender(320, 240, 1, 8));
  const auto near = cache.find({0.9f, 0, 0}, {0, 1, 0});
  EXPECT_TRUE(!near || luminance(*near) > 0.1f);
  EXPECT_GT(cache.size(), 3u);
}

TEST(IrradianceCache, GradientsAreDifferences) {
  const Scene scene = corner();
  const Traced traced(scene, constantProbe({16, 8}, Rgb(1)));
  const vec3 up(0, 1, 0);
  constexpr float kSamples = 60'000, kStep = 0.1f;
  const IrradianceRecord here = recordAt(traced, {0, 1, 0}, up, kSamples);
  const auto at = [&](float x, float z) {
    return luminance(recordAt(traced, {x, 1, z}, up, kSamples).irradiance);
  };
  const auto gradient = [](const std::array<vec3, 3>& g) {
    return 0.2126f * g[0] + 0.7152f * g[1] + 0.0722f * g[2];
  };
  const float perMetre = (at(kStep, 0) - at(-kStep, 0)) / (2 * kStep);
  EXPECT_GT(perMetre, 0.05f);  // towards the wall
  EXPECT_NEAR(gradient(here.translation).x, perMetre, 0.1f * perMetre);
  EXPECT_NEAR(gradient(here.translation).z, 0, 0.1f * perMetre);
  EXPECT_NEAR(gradient(here.translation).y, 0, 1e-6f);
  // The gradient by rotation of the normal, towards the wall and along it.
  const auto turned = [&](const vec3& towards) {
    const vec3 normal = glm::normalize(up + 0.1f * towards);
    const float actual = luminance(recordAt(traced, {0, 1, 0}, normal, kSamples).irradiance);
    const float told = luminance(here.irradianceAt(here.position, normal));
    return std::pair(actual - luminance(here.irradiance), told - luminance(here.irradiance));
  };
  const auto [actual, told] = turned({1, 0, 0});
  EXPECT_GT(actual, 0.01f);
  EXPECT_NEAR(told, actual, 0.1f * actual);
  EXPECT_NEAR(turned({0, 0, 1}).second, 0, 0.1f * actual);
}

TEST(IrradianceCache, RadiiAreThoseOfNeighbours) {
  const Traced traced(room(), constantProbe({16, 8}, Rgb(1)));
  const IrradianceCache cache = traced.fill(0.4f, inRoom(), smallRender(96, 72, 1, 4));
  ASSERT_GT(cache.size(), 20u);
  for (const auto& a : cache.records())
    for (const auto& b : cache.records()) {
      const float distance = glm::length(a.position - b.position);
      if (distance >= cache.error() * (a.radius + b.radius) ||
          glm::dot(a.normal, b.normal) <= -0.5f)
        continue;
      EXPECT_LE(a.radius, std::max(b.radius + distance, a.leastRadius) * 1.0001f);
    }
}

TEST(IrradianceCache, WeightsFallToNothing) {
  IrradianceCache cache(0.5f);
  const auto add = [&](float x, float irradiance) {
    IrradianceRecord record;
    record.position = {x, 0, 0}, record.normal = {0, 1, 0};
    record.irradiance = Rgb(irradiance);
    record.radius = 1;
    cache.add(record);
  };
  add(0, 1), add(0.8f, 3);
  const vec3 up(0, 1, 0);
  EXPECT_FALSE(cache.find({-0.51f, 0, 0}, up));
  EXPECT_EQ(cache.find({0.1f, 0, 0}, up)->x, 1);
  EXPECT_NEAR(cache.find({0.3001f, 0, 0}, up)->x, 1, 0.01f);  // the second one begins
  EXPECT_NEAR(cache.find({0.4f, 0, 0}, up)->x, 2, 1e-5f);
  EXPECT_FALSE(cache.find({0.1f, 0, 0}, {1, 0, 0}));
  EXPECT_FALSE(cache.find({0.1f, -0.2f, 0}, up));  // behind the surfaces that the record sees
  EXPECT_TRUE(cache.find({0.1f, 0.2f, 0}, up));
}

TEST(IrradianceCache, ArchivesItsRecords) {
  const Traced traced(corner(), constantProbe({16, 8}, Rgb(1)));
  IrradianceCache cache = traced.fill(0.5f, topCamera(6, 40), smallRender(40, 40, 1, 3));
  ASSERT_GT(cache.size(), 2u);
  MemoryWriter writer;
  cache.archive(writer);
  IrradianceCache read(0.5f);
  MemoryReader reader(writer.contents);
  read.archive(reader);
  ASSERT_EQ(read.size(), cache.size());
  EXPECT_EQ(*read.find({0, 0, 0}, {0, 1, 0}), *cache.find({0, 0, 0}, {0, 1, 0}));
  std::vector<char> cut(writer.contents.begin(), writer.contents.end() - 9);
  MemoryReader damaged(cut);
  EXPECT_THROW(read.archive(damaged), InputError);
}

TEST(IrradianceCache, DoesNotDependOnThreads) {
  const Image sky = overcastProbe({32, 16}, Rgb(1), 0.3);
  const auto withThreads = [&](size_t threads) {
    const ThreadLimit control(threads);
    return renderRow("importance+irradiance-cache:0.5", room(), inRoom(), sky,
                     smallRender(40, 30, 2, 4))
        .film.mean();
  };
  EXPECT_EQ(withThreads(1).texels, withThreads(3).texels);
}

Material clearGlass(float ior, const Rgb& attenuation) {
  Material m;
  m.metallic = 0;
  m.roughness = 0;
  m.ior = ior;
  m.extended.emplace();
  m.extended->transmission = 1;
  m.extended->thinWalled = false;
  m.extended->attenuation = attenuation;
  return m;
}

Image renderTop(const Scene& scene, const Image& probe, RenderSettings settings, bool caches) {
  if (caches) settings.cacheError = 0.2f;
  return renderScene(scene, topCamera(2, 20), Probe(probe), "importance", settings).film.mean();
}

// Relative difference of the mean luminances.
double changeByCache(const Scene& scene, const Image& probe, const RenderSettings& settings) {
  const auto mean = [&](bool caches) {
    return double(luminance(meanColor(renderTop(scene, probe, settings, caches))));
  };
  return mean(true) / mean(false) - 1;
}

// Absorbing bodies within one another, and a coated one that is half glass.
TEST(IrradianceCache, LeavesGlassInViewAsItIs) {
  Scene scene;
  addSphere(scene, addMaterial(scene, clearGlass(1.5f, {1, 2, 0.3f})), {0, 0, 0}, 0.6f);
  addSphere(scene, addMaterial(scene, clearGlass(1.33f, {0.1f, 4, 2})), {0, 0, 0}, 0.3f);
  const Image sky = gradientProbe({32, 16}, Rgb(0.5f), {0.2, 0.3, 0.1});
  const RenderSettings settings = smallRender(24, 24, 16, 8);
  const Image traced = renderTop(scene, sky, settings, false);
  const Image cached = renderTop(scene, sky, settings, true);
  for (size_t i = 0; i < traced.texels.size(); ++i)
    EXPECT_NEAR(cached.texels[i], traced.texels[i], 1e-5f);
  for (Material& m : scene.materials) m.extended->transmission = 0.5f;
  EXPECT_NEAR(changeByCache(scene, sky, smallRender(24, 24, 64, 8)), 0, 0.02);
}

// A lamp in a ball of glass with the index of air, and a probe behind a sheet or a straight body:
// light of sources, which is not in the records too.
TEST(SlowIrradianceCache, CountsLightBehindGlassOnce) {
  const auto floorUnder = [](const Material& material) {
    Scene scene;
    addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    addMaterial(scene, material);
    return scene;
  };
  const Image black = constantProbe({16, 8}, Rgb(0));
  Scene ball = floorUnder(clearGlass(1, Rgb(0.2f)));
  addSphere(ball, 1, {1, 1, 0}, 0.8f, 16);
  Material lamp = lambert(Rgb(0));
  lamp.emission = Rgb(5);
  addQuad(ball, addMaterial(ball, lamp), {0.6f, 1, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f});
  EXPECT_NEAR(changeByCache(ball, black, smallRender(24, 24, 512, 4)), 0, 0.03);

  Image sky = constantProbe({32, 16}, Rgb(0.5f));
  sky.setRgb(8, 3, Rgb(50));
  Material pane = clearGlass(1.5f, Rgb(0));
  pane.extended->thinWalled = true;
  Scene sheet = floorUnder(pane);
  addQuad(sheet, 1, {-9, 3, -9}, {0, 0, 18}, {18, 0, 0});
  EXPECT_NEAR(changeByCache(sheet, sky, smallRender(24, 24, 128, 4)), 0, 0.03);

  Scene straight = floorUnder(clearGlass(1.5f, Rgb(0)));
  addSphere(straight, 1, {1.2f, 1, 0}, 0.9f, 16);
  passShadowsStraight(straight.materials);
  EXPECT_NEAR(changeByCache(straight, sky, smallRender(24, 24, 256, 4)), 0, 0.03);
}

// A white sheet that transmits a part of the light, before a white wall, in a white furnace.
TEST(IrradianceCache, SeesThroughSmoothSheetsOnce) {
  for (const float transmission : {0.1f, 0.5f, 0.9f, 1.0f}) {
    Scene scene;
    Material sheet = lambert(Rgb(1));
    sheet.roughness = 0;
    sheet.doubleSided = true;
    sheet.extended.emplace().transmission = transmission;
    addQuad(scene, addMaterial(scene, sheet), {-1, 1, 1}, {2, 0, 0}, {0, 0, -2});
    addQuad(scene, addMaterial(scene, lambert(Rgb(1))), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
    const Image white = constantProbe({16, 8}, Rgb(1));
    const RenderSettings settings = smallRender(12, 12, 64, 40);
    EXPECT_NEAR(meanColor(renderTop(scene, white, settings, true)).y, 1, 0.03) << transmission;
  }
}

// Two tinted sheets at one distance under a white ceiling, and a lamp flush with a sheet: the light
// from behind the first of the surfaces.
TEST(SlowIrradianceCache, MeetsAllSurfacesOfAPlace) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
  Material pane = clearGlass(1, Rgb(0));
  pane.specular = 0;
  pane.baseColor = {0.5f, 0.6f, 0.7f, 1};
  pane.extended->thinWalled = true;
  const int tinted = addMaterial(scene, pane);
  for (int i = 0; i < 2; ++i) addQuad(scene, tinted, {-2, 1, -2}, {0, 0, 4}, {4, 0, 0});
  Scene withLamp = scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.9f))), {-2, 3, -2}, {4, 0, 0}, {0, 0, 4});
  const Image sky = constantProbe({16, 8}, Rgb(1));
  const Camera camera = Camera::lookAt({0, 0.9f, 0}, {0, 0, 0}, {0, 0, -1}, 0.5f);
  const auto change = [&](const Scene& s, const Image& probe) {
    const auto mean = [&](float error) {
      RenderSettings settings = smallRender(24, 24, 1024, 4);
      settings.cacheError = error;
      return double(luminance(
          meanColor(renderScene(s, camera, Probe(probe), "importance", settings).film.mean())));
    };
    return mean(0.1f) / mean(0) - 1;
  };
  EXPECT_NEAR(change(scene, sky), 0, 0.006);

  Material lamp = lambert(Rgb(0));
  lamp.emission = Rgb(5);
  lamp.doubleSided = true;
  addQuad(withLamp, addMaterial(withLamp, lamp), {-0.4f, 1, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f});
  EXPECT_NEAR(change(withLamp, constantProbe({16, 8}, Rgb(0))), 0, 0.01);
}

// Squares of radiances at the limits of floats.
TEST(IrradianceCache, DoesNotDependOnTheUnitOfLight) {
  const Image unit = gradientProbe({32, 16}, Rgb(0.5f), {0.2, 0.3, 0.1});
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
  addSphere(scene, 0, {0, 0.3f, 0}, 0.3f, 12);
  const RenderSettings settings = smallRender(16, 16, 4, 4);
  const Image expected = renderTop(scene, unit, settings, true);
  for (const float scale : {0x1p-80f, 0x1p70f}) {
    Image probe = unit;
    for (float& texel : probe.texels) texel *= scale;
    const Image found = renderTop(scene, probe, settings, true);
    for (size_t i = 0; i < expected.texels.size(); ++i)
      ASSERT_NEAR(found.texels[i] / scale, expected.texels[i], 1e-5f) << scale;
  }
}

// A tent seen from above through the hidden backs of its roof: records are as dense as pixels ask
// for, however far the camera is from the roof.
TEST(SlowIrradianceCache, SeesThroughHiddenBacks) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.7f))), {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
  Material roof = lambert({0.8f, 0.2f, 0.2f});
  roof.doubleSided = false;
  addQuad(scene, addMaterial(scene, roof), {-1, 0.8f, -1}, {2, 0, 0}, {0, 0, 2});
  const Image sky = constantProbe({32, 16}, Rgb(1));
  EXPECT_NEAR(changeByCache(scene, sky, smallRender(48, 48, 128, 4)), 0, 0.02);
}

// Only the records have the light that rough glass and mirrors throw onto the floor.
TEST(SlowIrradianceCache, LosesNoLightBehindRoughGlass) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
  Material frosted = clearGlass(1.5f, Rgb(0));
  frosted.roughness = 0.5f;
  addSphere(scene, addMaterial(scene, frosted), {0.9f, 0.8f, 0}, 0.7f, 24);
  const Image sky = gradientProbe({32, 16}, Rgb(0.5f), {0.2, 0.3, 0.1});
  EXPECT_NEAR(changeByCache(scene, sky, smallRender(24, 24, 256, 6)), 0, 0.03);
}

TEST(IrradianceCache, HasNothingToAddWithoutASecondBounce) {
  const Image sky = overcastProbe({32, 16}, Rgb(1), 0.3);
  Scene scene = corner();
  scene.materials[0].emission = Rgb(0.1f);
  for (const int depth : {0, 1}) {
    const RenderSettings settings = smallRender(16, 16, 8, depth);
    EXPECT_EQ(renderTop(scene, sky, settings, true).texels,
              renderTop(scene, sky, settings, false).texels);
  }
}

// All kinds of materials and lights: emission, mirrors, veils, plastics.
TEST(SlowIrradianceCache, HasLittleBias) {
  const Camera camera = Camera::lookAt({0, 1.5f, 4}, {0, 0.5f, 0}, {0, 1, 0}, 0.7f);
  for (const NamedScene& named : threeScenes()) {
    const RenderSettings settings = smallRender(64, 48, 256, 6);
    const Image traced =
        renderRow("importance", named.scene, camera, named.probe, settings).film.mean();
    for (const char* error : {"0.2", "0.1"}) {
      const Image cached = renderRow(std::string("importance+irradiance-cache:") + error,
                                     named.scene, camera, named.probe, settings)
                               .film.mean();
      const double ratio = luminance(meanColor(cached)) / luminance(meanColor(traced));
      EXPECT_NEAR(ratio, 1, 0.25 * std::stod(error)) << named.name;
    }
  }
}

// In a room, in which nearly all light is reflected.
TEST(SlowIrradianceCache, LightsARoom) {
  const Image sky = overcastProbe({32, 16}, Rgb(1), 0.3);
  RenderSettings settings = smallRender(64, 48, 1024, 6);
  const Image traced = renderRow("importance", room(), inRoom(), sky, settings).film.mean();
  settings.samples = 64, settings.seed = 3;
  const Image few = renderRow("importance", room(), inRoom(), sky, settings).film.mean();
  const auto relMse = [&](const Image& image) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const double truth = luminance(traced.rgb(x, y));
        sum += std::pow((luminance(image.rgb(x, y)) - truth) / (truth + 0.01), 2);
      }
    return sum / (image.width * image.height);
  };
  for (const char* error : {"0.3", "0.15"}) {
    const Image cached = renderRow(std::string("importance+irradiance-cache:") + error, room(),
                                   inRoom(), sky, settings)
                             .film.mean();
    const double ratio = luminance(meanColor(cached)) / luminance(meanColor(traced));
    EXPECT_NEAR(ratio, 1, 0.25 * std::stod(error)) << error;
    EXPECT_LT(relMse(cached), 0.5 * relMse(few)) << error;
  }
}

}  // namespace
}  // namespace chromeball::irradiance_cache_test
