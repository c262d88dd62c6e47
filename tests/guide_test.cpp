// SPDX-License-Identifier: Apache-2.0
// Guided light samples: unbiased, with less variance where walls hide the probe, and not used
// elsewhere.
#include <gtest/gtest.h>

#include "base/parallel.h"
#include "composite/render_composite.h"
#include "guiding/light_guide.h"
#include "lighting/finite_surroundings.h"
#include "lighting/polygon_lights.h"
#include "lighting/scene_sources.h"
#include "lighting/suns.h"
#include "measure/statistics.h"
#include "probe/irradiance.h"
#include "probe/synth.h"
#include "small_scenes.h"

namespace chromeball::guide_test {
namespace {

float random(uint64_t i, uint64_t purpose) { return toUnit(uint32_t(hash(i, purpose))); }

// Light from the left third of the sky for x < 0 and from the right third for x > 0, which the
// strategy samples with pdf `strategyPdf`.
std::vector<LightRecord> twoRooms(size_t count, float strategyPdf) {
  std::vector<LightRecord> records;
  for (uint64_t i = 0; i < count; ++i) {
    const vec3 position(2 * random(i, 1) - 1, 0, 2 * random(i, 2) - 1);
    vec3 direction = squareToUniformHemisphere({random(i, 3), random(i, 4) / 3});
    direction = {position.x < 0 ? -direction.z : direction.z, std::fabs(direction.y), direction.x};
    const float bsdfPdf = direction.y * kInvPi;
    records.push_back({position, {0, 1, 0}, direction, direction.y, 1, strategyPdf, bsdfPdf});
  }
  return records;
}

TEST(LightGuide, LearnsEachRegion) {
  LightGuide guide;
  EXPECT_EQ(guide.find({0, 0, 0}, {0, 1, 0}), nullptr);
  guide.learn(twoRooms(40'000, 1e-3f));
  EXPECT_GT(guide.guidedRegions(), 8u);
  EXPECT_LT(guide.moments().with, 0.6 * guide.moments().without);
  const vec3 left = glm::normalize(vec3(-1, 0.5f, 0.1f)), right = left * vec3(-1, 1, 1);
  for (uint64_t i = 0; i < 100; ++i) {
    const float x = random(i, 5) < 0.5f ? -0.5f : 0.5f, z = 2 * random(i, 6) - 1;
    const GuideRegion* region = guide.find({x, 0, z}, {0, 1, 0});
    ASSERT_NE(region, nullptr);
    const vec3 &bright = x < 0 ? left : right, &dark = x < 0 ? right : left;
    EXPECT_GT(region->tree().pdf(bright), 20 * region->tree().pdf(dark));
    EXPECT_NEAR(region->pdf(7, bright),
                region->strategyFraction() * 7 +
                    (1 - region->strategyFraction()) * region->tree().pdf(bright),
                1e-4f);
  }
  EXPECT_EQ(guide.find({0, 0, 0}, {0, -1, 0}), nullptr);  // nothing learned about ceilings
}

TEST(LightGuide, LeavesAGoodStrategyAlone) {
  LightGuide guide;
  guide.learn(twoRooms(40'000, 10));
  EXPECT_EQ(guide.guidedRegions(), 0u);
  EXPECT_EQ(guide.find({0.5f, 0, 0}, {0, 1, 0}), nullptr);
}

TEST(LightGuide, BearsRecordsAtOnePoint) {
  std::vector<LightRecord> records = twoRooms(10'000, 1e-3f);
  for (LightRecord& r : records) r.position = {1e10f, -1e-8f, 3};
  LightGuide guide;
  guide.learn(records);
  EXPECT_LE(guide.guidedRegions(), 1u);
  guide.learn({});
  EXPECT_EQ(guide.guidedRegions(), 0u);
  EXPECT_EQ(guide.find({0, 0, 0}, {0, 1, 0}), nullptr);
}

// A convex body of albedo a in a furnace of radiance 1 has radiance a, with any guide.
TEST(LightGuide, LeavesTheFurnaceExact) {
  Scene scene;
  addSphere(scene, addMaterial(scene, lambert(Rgb(0.7f))), {0, 0, 0}, 1, 48);
  const Probe probe(constantProbe({16, 8}, Rgb(1)));
  const World world(scene, {}, allTables());
  const auto lighting = makeStrategy("importance", probe, Mis::Balance, "test");
  LightGuide guide;
  std::vector<LightRecord> records;
  for (uint64_t i = 0; i < 20'000; ++i) {
    const vec3 normal = squareToUniformSphere({random(i, 1), random(i, 2)});
    const vec3 direction = glm::normalize(normal + vec3(0, 1.5f * random(i, 3), random(i, 4)));
    records.push_back({normal, normal, direction, 1, 1, 1e-3f, 0.1f});
  }
  guide.learn(std::move(records));
  ASSERT_GT(guide.guidedRegions(), 6u);

  RenderSettings settings = smallRender(32, 32, 256, 1);
  PathSettings path = settings.path();
  path.guide = &guide;
  const Camera camera = Camera::lookAt({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.2f);
  const std::atomic<bool> stop = false;
  const PathTracer tracer(world, *lighting, path);
  const RenderResult r = render(
      PathIntegrator(tracer), world, camera, settings, [](double) {}, stop);
  const Moments pixels = Moments::of(r.film.errors().luminances);
  EXPECT_LT(std::sqrt(pixels.variance / pixels.count), 5e-4);
  EXPECT_NEAR(pixels.mean, 0.7, 1e-3);
}

// 4 x 3 x 4 m with a window in the wall at x = -2, and a ball. The sun is on the other side.
Scene room() {
  Scene s;
  const int wall = addMaterial(s, lambert(Rgb(0.6f)));
  const vec3 x(4, 0, 0), y(0, 3, 0), z(0, 0, 4), low(-2, 0, -2);
  addQuad(s, wall, low, z, x);
  addQuad(s, wall, low + y, x, z);
  addQuad(s, wall, low, x, y);
  addQuad(s, wall, low + z, y, x);
  addQuad(s, wall, low + x, z, y);
  addQuad(s, wall, low, y, 0.3f * z);
  addQuad(s, wall, low + 0.6f * z, y, 0.4f * z);
  addQuad(s, wall, low, 0.4f * y, z);
  addQuad(s, wall, low + 0.7f * y, 0.3f * y, z);
  addSphere(s, addMaterial(s, lambert({0.7f, 0.3f, 0.2f})), {0.3f, 0.6f, 0}, 0.6f, 16);
  Material gloss;
  gloss.baseColor = {0.9f, 0.8f, 0.6f, 1};
  gloss.roughness = 0.4f;
  addSphere(s, addMaterial(s, gloss), {-0.8f, 0.4f, 0.6f}, 0.4f, 16);
  return s;
}

Camera inside() {
  return Camera::lookAt({1.7f, 1.6f, 1.8f}, {-0.3f, 0.8f, 0}, {0, 1, 0}, glm::radians(60.0f));
}

// A clear sky with its sun towards +x.
Probe sunBehind() {
  return Probe(clearSkyProbe({128, 64}, {.sunElevation = 30, .sunAzimuth = 270}));
}

RenderSettings guidedRender(int width, int height, uint32_t samples, Guiding guiding,
                            uint64_t seed = 0) {
  RenderSettings settings = smallRender(width, height, samples, 4, seed);
  settings.guiding = guiding;
  return settings;
}

TEST(SlowGuide, AgreesWithTheUnguidedRenderInEveryPixel) {
  constexpr int kSeeds = 12, kSize = 48;
  const Scene scene = room();
  const Probe probe = sunBehind();
  std::vector<std::vector<double>> plain(kSize * kSize), guided(kSize * kSize);
  std::vector<double> means[2];
  for (uint64_t seed = 0; seed < 2 * kSeeds; ++seed) {
    RenderSettings settings =
        guidedRender(kSize, kSize, 64, seed % 2 ? Guiding::On : Guiding::Off, seed);
    settings.adaptive = seed % 4 < 2;
    const RenderResult r = renderScene(scene, inside(), probe, "importance", settings);
    EXPECT_EQ(r.guidedRegions > 0, seed % 2 == 1);
    const Image mean = r.film.mean();
    means[seed % 2].push_back(luminance(meanColor(mean)));
    for (int i = 0; i < kSize * kSize; ++i)
      (seed % 2 ? guided : plain)[size_t(i)].push_back(luminance(mean.rgb(i % kSize, i / kSize)));
  }
  double lowest = 1;
  for (size_t i = 0; i < kSize * kSize; ++i) {
    const Moments a = Moments::of(guided[i]), b = Moments::of(plain[i]);
    if (a.variance > 0 || b.variance > 0) lowest = std::min(lowest, welchTest(a, b));
  }
  EXPECT_GT(lowest, sidak(1e-3, kSize * kSize));
  // The means of whole images are much more precise than any pixel.
  EXPECT_GT(welchTest(Moments::of(means[0]), Moments::of(means[1])), 1e-3);
}

// A guide learns from the first samples of the pixels that it then serves. Later samples from the
// same points, which fill the gaps between the first, are .15% too bright here.
TEST(SlowGuide, LeavesTheMeanUnbiased) {
  constexpr int kSeeds = 250, kSize = 16;
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
  const std::vector<vec3> directions = texelDirections({256, 128});
  const Image radiance = colorImage(256, 128, [&](int x, int y) {
    return Rgb(3 * std::pow(directions[size_t(y * 256 + x)].x, 4.0f));
  });
  const double exact = 0.5 / kPi * exactIrradiance(radiance, std::vector<vec3>{{0, 1, 0}})[0].x;
  const Probe probe(radiance);
  std::vector<double> means;
  int guided = 0;
  for (uint64_t seed = 0; seed < kSeeds; ++seed) {
    const RenderResult r = renderScene(scene, topCamera(1, 40), probe, "importance",
                                       guidedRender(kSize, kSize, 64, Guiding::On, seed));
    guided += r.guidedRegions > 0;
    means.push_back(luminance(meanColor(r.film.mean())));
  }
  EXPECT_GT(guided, kSeeds * 9 / 10);
  const Moments all = Moments::of(means);
  EXPECT_LT(std::fabs(all.mean - exact), 3.3 * std::sqrt(all.variance / all.count));  // p = 1e-3
}

// Light from the walls of a box around the room, whose directions differ from point to point.
TEST(SlowGuide, AgreesInSurroundings) {
  constexpr int kSeeds = 16, kSize = 40, kTiles = 16, kTile = kSize / 4;
  const Scene scene = room();
  const World world(scene, {}, allTables());
  const Probe probe = sunBehind();
  Surroundings box;
  box.shape = Surroundings::Shape::Box;
  box.min = {-5, -1, -4}, box.max = {4, 6, 5};
  box.capture = {-4, 1, 0};
  const FiniteSurroundings lighting(makeStrategy("importance", probe, Mis::Balance, "test"), probe,
                                    box);
  const std::atomic<bool> stop = false;
  std::vector<std::vector<double>> tiles[2];
  for (auto& some : tiles) some.resize(kTiles);
  double squared[2] = {0, 0};
  for (uint64_t seed = 0; seed < 2 * kSeeds; ++seed) {
    const bool on = seed % 2;
    const RenderResult r = render(
        world, inside(), lighting,
        guidedRender(kSize, kSize, 64, on ? Guiding::On : Guiding::Off, seed), [](double) {}, stop);
    EXPECT_EQ(r.guidedRegions > 0, on);
    EXPECT_EQ(r.causticFraction, 0);  // photons do not start from walls
    squared[on] += r.film.noise().noise * r.film.noise().noise;
    const Image mean = r.film.mean();
    for (int t = 0; t < kTiles; ++t) {
      double sum = 0;
      for (int i = 0; i < kTile * kTile; ++i)
        sum += luminance(mean.rgb(t % 4 * kTile + i % kTile, t / 4 * kTile + i / kTile));
      tiles[on][size_t(t)].push_back(sum);
    }
  }
  for (size_t t = 0; t < kTiles; ++t)
    EXPECT_GT(welchTest(Moments::of(tiles[0][t]), Moments::of(tiles[1][t])), sidak(1e-3, kTiles));
  EXPECT_LT(squared[1], squared[0]);
}

// Compares at equal samples; guided light samples take up to 1.7 times the time.
TEST(SlowGuide, ReducesTheVarianceInARoom) {
  const Scene scene = room();
  double squared[2] = {0, 0};
  for (uint64_t seed = 0; seed < 4; ++seed)
    for (const Guiding guiding : {Guiding::Off, Guiding::Auto}) {
      const RenderResult r = renderScene(scene, inside(), sunBehind(), "importance",
                                         guidedRender(80, 60, 64, guiding, seed));
      EXPECT_EQ(r.guidedRegions > 0, guiding == Guiding::Auto);
      squared[guiding == Guiding::Auto] += r.film.noise().noise * r.film.noise().noise;
    }
  EXPECT_LT(squared[1], squared[0] / 2.5);
}

// Images of independent seeds scatter as much as `noise` says.
TEST(SlowGuide, NoiseIsThatOfGuidedRenders) {
  constexpr int kSeeds = 32, kSize = 48;
  const Scene scene = room();
  std::vector<std::vector<double>> values(kSize * kSize);
  std::vector<double> estimated(kSize * kSize);
  for (uint64_t seed = 0; seed < kSeeds; ++seed) {
    const RenderResult r = renderScene(scene, inside(), sunBehind(), "importance",
                                       guidedRender(kSize, kSize, 32, Guiding::On, seed));
    EXPECT_GT(r.guidedRegions, 0u);
    const PixelErrors errors = r.film.errors();
    for (size_t i = 0; i < kSize * kSize; ++i) {
      values[i].push_back(errors.luminances[i]);
      estimated[i] += errors.halves[i].w / kSeeds;
    }
  }
  double measured = 0, sum = 0;
  for (size_t i = 0; i < kSize * kSize; ++i) {
    const Moments m = Moments::of(values[i]);
    measured += m.variance / (m.mean * m.mean);
    sum += estimated[i] / (m.mean * m.mean);
  }
  EXPECT_NEAR(sum / measured, 1, 0.15);
}

// Tile means and squared noise of renders with and without a guide, of independent seeds.
class GuidedAndNot {
 public:
  static constexpr int kSize = 40, kTiles = 16, kTile = kSize / 4, kSeeds = 12;

  // render(settings): the image, the squared noise, and whether light samples were guided.
  struct Picture {
    Image mean;
    double squaredNoise;
    bool isGuided;
  };
  template <class Render>
  explicit GuidedAndNot(const Render& render) {
    for (auto& some : tiles_) some.resize(kTiles);
    for (uint64_t seed = 0; seed < 2 * kSeeds; ++seed) {
      const bool on = seed % 2;
      const Picture picture =
          render(guidedRender(kSize, kSize, 64, on ? Guiding::On : Guiding::Off, seed));
      EXPECT_EQ(picture.isGuided, on);
      squared_[on] += picture.squaredNoise;
      for (int t = 0; t < kTiles; ++t) {
        double sum = 0;
        for (int i = 0; i < kTile * kTile; ++i)
          sum += luminance(picture.mean.rgb(t % 4 * kTile + i % kTile, t / 4 * kTile + i / kTile));
        tiles_[on][size_t(t)].push_back(sum);
      }
    }
  }

  void expectEqualMeans() const {
    for (size_t t = 0; t < kTiles; ++t)
      EXPECT_GT(welchTest(Moments::of(tiles_[0][t]), Moments::of(tiles_[1][t])),
                sidak(1e-3, kTiles))
          << t;
  }
  double gain() const { return squared_[0] / squared_[1]; }

 private:
  std::vector<std::vector<double>> tiles_[2];
  double squared_[2] = {0, 0};
};

double squaredNoise(const Film& film) { return film.noise().noise * film.noise().noise; }

// Light groups are guided like the picture without them, and add up to it.
TEST(SlowGuide, ServesLightGroups) {
  const Scene scene = room();
  const World world(scene, {}, allTables());
  const Probe probe = sunBehind();
  const SplitProbe lighting(makeStrategy("importance", probe, Mis::Balance, "test"), probe);
  ASSERT_EQ(lighting.groups().size(), 2u);
  const std::atomic<bool> stop = false;
  const GuidedAndNot renders([&](RenderSettings settings) {
    settings.lightGroups = true;
    const RenderResult r = render(
        world, inside(), lighting, settings, [](double) {}, stop);
    Image sum(settings.width, settings.height, 3);
    for (int y = 0; y < sum.height; ++y)
      for (int x = 0; x < sum.width; ++x)
        sum.setRgb(x, y,
                   Rgb((r.layers.value(x, y, 0) + r.layers.value(x, y, 1)) /
                       double(r.layers.count(x, y))));
    const Image mean = r.film.mean();
    for (size_t i = 0; i < sum.texels.size(); ++i)
      EXPECT_NEAR(sum.texels[i], mean.texels[i], 1e-4f * mean.texels[i]);
    return GuidedAndNot::Picture{sum, squaredNoise(r.film), r.guidedRegions > 0};
  });
  renders.expectEqualMeans();
  EXPECT_GT(renders.gain(), 1);  // a quarter of the samples train, and count as much as others
}

// The ball is an object, the room is the local scene.
TEST(SlowGuide, ServesComposites) {
  const Scene scene = room();
  ObjectMask isObject(scene.instances.size(), false);
  isObject[9] = true;
  const World world(scene, rayMasks(isObject), allTables());
  const Probe probe = sunBehind();
  const auto lighting = makeStrategy("importance", probe, Mis::Balance, "test");
  const Image plate = constantProbe({GuidedAndNot::kSize, GuidedAndNot::kSize}, Rgb(0.5f));
  const std::atomic<bool> stop = false;
  const GuidedAndNot renders([&](const RenderSettings& settings) {
    const CompositeRender r = renderComposite(
        world, inside(), *lighting, plate, settings, Passes::One, false, [](double) {}, stop);
    return GuidedAndNot::Picture{r.mean, squaredNoise(r.result.film), r.result.guidedRegions > 0};
  });
  renders.expectEqualMeans();
}

// Polygons of the probe as sources of their own: one that all rays see, and one that only its
// samples find, in sight of the room's window and behind its wall.
TEST(SlowGuide, ServesPolygonsOfTheProbe) {
  const Scene scene = room();
  const World world(scene, {}, allTables());
  const auto aroundOf = [](const vec3& middle, const char* name) {
    const Frame frame(glm::normalize(middle));
    std::vector<dvec3> corners;
    for (const vec2 at : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1)})
      corners.push_back(glm::normalize(dvec3(frame.toWorld({0.2f * at.x, 0.2f * at.y, 1}))));
    return SphericalPolygon(corners, name);
  };
  for (const bool isIllum : {false, true}) {
    Image map = constantProbe({128, 64}, Rgb(0.2f));
    const std::vector<SphericalPolygon> polygons{aroundOf({-1, 0.15f, 0}, "window"),
                                                 aroundOf({1, 0.3f, 0}, "other")};
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 128; ++x) {
        const dvec3 direction = texelDirection({128, 64}, x, y);
        if (polygons[0].contains(direction)) map.setRgb(x, y, Rgb(3, 4, 5));
        if (polygons[1].contains(direction)) map.setRgb(x, y, Rgb(90));
      }
    const PolygonExtraction extraction = extractPolygons(map, polygons);
    std::vector<PolygonLight> lights;
    for (size_t i = 0; i < 2; ++i)
      lights.push_back({extraction.sources[i], isIllum && i == 0, "source"});
    const Probe rest(extraction.remainder);
    std::vector<std::unique_ptr<LightSource>> parts;
    parts.push_back(makeStrategy("importance", rest, Mis::Balance, "test"));
    parts.push_back(
        std::make_unique<PolygonLights>(lights, constantProbe({2, 1}, Rgb(0)), Rotation()));
    const CombinedLight lighting(std::move(parts));
    const std::atomic<bool> stop = false;
    const GuidedAndNot renders([&](const RenderSettings& settings) {
      const RenderResult r = render(
          world, inside(), lighting, settings, [](double) {}, stop);
      return GuidedAndNot::Picture{r.film.mean(), squaredNoise(r.film), r.guidedRegions > 0};
    });
    renders.expectEqualMeans();
    EXPECT_GT(renders.gain(), 0.9);
  }
}

TEST(Guide, IsNotUsedInTheOpen) {
  const NamedScene named = std::move(threeScenes()[0]);
  const Camera camera = Camera::lookAt({0.5f, 2.5f, 4}, {0, 0.5f, 0}, {0, 1, 0}, 0.7f);
  const Probe probe(named.probe);
  const auto rendered = [&](Guiding guiding) {
    return renderScene(named.scene, camera, probe, "importance", guidedRender(60, 40, 32, guiding));
  };
  const RenderResult automatic = rendered(Guiding::Auto);
  EXPECT_EQ(automatic.guidedRegions, 0u);
  EXPECT_EQ(automatic.film.mean().texels, rendered(Guiding::Off).film.mean().texels);
}

TEST(Guide, TheNumberOfThreadsChangesNothing) {
  const Scene scene = room();
  std::vector<Image> images;
  for (const size_t threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    const RenderResult r = renderScene(scene, inside(), sunBehind(), "importance",
                                       guidedRender(70, 56, 32, Guiding::Auto));
    EXPECT_GT(r.guidedRegions, 0u);
    images.push_back(r.film.mean());
  }
  EXPECT_EQ(images[0].texels, images[1].texels);
  EXPECT_EQ(images[0].texels, images[2].texels);
}

TEST(Guide, HasNoEffectUnderABlackProbe) {
  const Probe black(constantProbe({8, 4}, Rgb(0)));
  const RenderResult r =
      renderScene(room(), inside(), black, "importance", guidedRender(20, 15, 16, Guiding::On));
  EXPECT_EQ(r.guidedRegions, 0u);
  EXPECT_EQ(meanColor(r.film.mean()), Rgb(0));
}

// Two kinds of samples, of variance 1 and 9, with weights of their inverse variances.
TEST(Film, WeighsSamples) {
  constexpr int kPixels = 4000, kNoisy = 8, kQuiet = 24;
  Film film(kPixels, 1);
  const auto add = [&](float deviation, int count, uint64_t purpose) {
    for (int x = 0; x < kPixels; ++x)
      for (int half = 0; half < Film::kHalves; ++half) {
        SampleSums sums;
        for (int i = 0; i < count / 2; ++i) {
          const uint64_t key = hash(uint64_t(x), uint64_t(2 * i + half), purpose);
          sums.add(Rgb(10 + deviation * std::sqrt(12.0f) * (toUnit(uint32_t(key)) - 0.5f)));
        }
        film.add(x, 0, half, sums);
      }
  };
  add(3, kNoisy, 1);
  film.weigh(1.0 / 9);
  add(1, kQuiet, 2);

  const PixelErrors errors = film.errors();
  double halves = 0, scatter = 0;
  for (int x = 0; x < kPixels; ++x) {
    halves += errors.halves[size_t(x)].w / kPixels;
    scatter += errors.scatter[size_t(x)].w / kPixels;
  }
  const Moments measured = Moments::of(errors.luminances);
  EXPECT_NEAR(measured.mean, 10, 5 * std::sqrt(measured.variance / kPixels));
  EXPECT_NEAR(measured.variance * (kNoisy / 9.0 + kQuiet), 1, 0.1);
  EXPECT_NEAR(halves / measured.variance, 1, 0.1);
  EXPECT_NEAR(scatter / measured.variance, 1, 0.1);
  EXPECT_EQ(film.sampleCounts().texels[0], float(kNoisy + kQuiet));
}

}  // namespace
}  // namespace chromeball::guide_test
