// SPDX-License-Identifier: Apache-2.0
// Probes under any rotation: views, samples and irradiance turn with them.
#include <gtest/gtest.h>

#include <array>

#include "lighting/importance.h"
#include "lighting/polygon_lights.h"
#include "lighting/suns.h"
#include "math/icosphere.h"
#include "measure/statistics.h"
#include "probe/convert.h"
#include "probe/irradiance.h"
#include "probe/synth.h"
#include "sphere_test.h"
#include "strategy_samples.h"
#include "test_probes.h"
#include "test_scene.h"

namespace chromeball::tilted_probe_test {
namespace {

const Rotation kTilt = Rotation::ofAngles({35, -50, 110});

Image sunOverSky() {
  Image map = gradientProbe({64, 32}, Rgb(0.4f, 0.5f, 0.7f), {0.3, 0.8, 0.2});
  map.setRgb(40, 9, Rgb(4000, 3000, 2000));
  map.setRgb(10, 14, Rgb(60, 90, 50));
  return map;
}

TEST(TiltedProbe, ShowsWhatTheMapShowsInTheTurnedDirection) {
  const Image map = gradientProbe({64, 32}, Rgb(0.4f, 0.5f, 0.7f), {0.3, 0.8, 0.2});
  const Probe level(map), tilted(map, kTilt);
  EXPECT_EQ(tilted.latLong().texels, map.texels);
  for (const vec3& d : icosphereNormals(4)) {
    const Rgb expected = level.radiance(d), seen = tilted.radiance(kTilt(d));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], expected[k], 1e-5f);
  }
}

TEST(TiltedProbe, LocateInvertsDirection) {
  const Probe probe(constantProbe({512, 256}, Rgb(1)), kTilt);
  for (int i = 0; i < 20000; ++i) {
    Probe::Position p{int(random1(i, 0) * 512), int(random1(i, 1) * 257), random1(i, 2),
                      random1(i, 3)};
    const vec3 d = probe.direction(p);
    ASSERT_NEAR(glm::length(d), 1, 1e-5);
    const Probe::Position q = probe.locate(d);
    const float dx = std::remainder(float(q.column - p.column) + q.s - p.s, 512.0f);
    ASSERT_NEAR(dx * p.sinTheta, 0, 4e-4) << p.row;
    ASSERT_NEAR(q.sinTheta, p.sinTheta, 1e-6);
  }
  EXPECT_TRUE(std::isnan(probe.radiance(vec3(NAN)).x));
}

TEST(SlowTiltedProbe, ImportanceSamplesFollowThePdf) {
  const std::vector<HardProbe> all = hardProbes();
  for (const HardProbe& c : all) {
    SCOPED_TRACE(c.name);
    const Probe probe(c.image, kTilt);
    const Importance importance(probe, false);
    const SphereTest test = testDirections(
        [&](int i) {
          return std::optional(
              importance.sampleDirection(double(random1(i, 0)), double(random1(i, 1))).wi);
        },
        [&](const vec3& w) { return double(importance.pdf(w)); }, 100000, 3, 16, 32);
    EXPECT_NEAR(test.totalProbability, 1, 5e-3);
    EXPECT_GT(test.chiSquare.pValue, sidak(1e-3, int(all.size())));
  }
}

// Few may differ: samples that rounding moves across an edge. `samplesTurn`: the samples turn too;
// samples within discs depend on the disc's own frame.
void expectTurned(const LightSource& level, const LightSource& tilted, const std::string& name,
                  bool samplesTurn = true) {
  SCOPED_TRACE(name);
  const vec3 normal = glm::normalize(vec3(0.3f, 0.8f, -0.4f));
  Samples a(level, normal), b(tilted, kTilt(normal));
  size_t count = 0, differing = 0;
  for (int i = 0; samplesTurn && i < 300; ++i) {
    const std::vector<DirectionSample> expected = a.take(i), seen = b.take(i);
    ASSERT_EQ(seen.size(), expected.size());
    for (size_t k = 0; k < seen.size(); ++k, ++count) {
      EXPECT_LT(glm::length(seen[k].wi - kTilt(expected[k].wi)), 2e-6f);
      EXPECT_EQ(seen[k].isDelta, expected[k].isDelta);
      const float e = luminance(expected[k].irradiance), s = luminance(seen[k].irradiance);
      differing += std::fabs(s - e) > 1e-3f * e;
    }
  }
  EXPECT_EQ(count > 0, samplesTurn);
  EXPECT_LE(differing, count / 100);
  differing = 0;
  const std::vector<vec3> directions = icosphereNormals(3);
  for (const vec3& d : directions) {
    const auto was = level.escaped(a.point(), d), is = tilted.escaped(b.point(), kTilt(d));
    const Rgb before = level.background({}, d), after = tilted.background({}, kTilt(d));
    differing += std::fabs(is.pdf - was.pdf) > 1e-3f * was.pdf ||
                 std::fabs(is.radiance.x - was.radiance.x) > 1e-3f * was.radiance.x ||
                 std::fabs(after.y - before.y) > 1e-3f * before.y;
  }
  EXPECT_LE(differing, directions.size() / 100);
}

TEST(TiltedProbe, EveryStrategyTurnsWithTheProbe) {
  const Image map = sunOverSky();
  const Probe level(map), tilted(map, kTilt);
  for (const char* name :
       {"importance", "median-cut:16", "median-cut-centre:16", "median-cut-area:16",
        "kollig-keller:16", "kollig-keller-average:16", "kollig-keller-strata:16", "penrose:30",
        "cube-grid:3", "irradiance-fit-ambient:4"})
    expectTurned(*makeStrategy(name, level, {Mis::Balance}, "test"),
                 *makeStrategy(name, tilted, {Mis::Balance}, "test"), name);
  for (const char* name : {"suns", "median-cut-disc:16"})
    expectTurned(*makeStrategy(name, level, {Mis::Balance}, "test"),
                 *makeStrategy(name, tilted, {Mis::Balance}, "test"), name, false);
}

TEST(TiltedProbe, ShownLightsTurnWithTheProbe) {
  const Image map = sunOverSky();
  const Probe level(map), tilted(map, kTilt);
  const StrategyOptions options(Mis::Balance, {}, true);
  for (const char* name : {"median-cut:16", "median-cut-area:16"})
    expectTurned(*makeStrategy(name, level, options, "test"),
                 *makeStrategy(name, tilted, options, "test"), name);
}

TEST(TiltedProbe, SplitSunsAndPolygonsTurnWithTheProbe) {
  const Image map = sunOverSky();
  const Probe level(map), tilted(map, kTilt);
  const SplitProbe whole(makeStrategy("importance", level, {Mis::Balance}, "test"), level);
  const SplitProbe turned(makeStrategy("importance", tilted, {Mis::Balance}, "test"), tilted);
  const SphericalPolygon window({directionAt(-20, 10), directionAt(-20, 30), directionAt(15, 30)},
                                "test");
  const PolygonExtraction extraction = extractPolygons(map, {window});
  const std::vector<PolygonLight> lights{{extraction.sources.front(), false, "window"}};
  const PolygonLights polygon(lights, Image(64, 32, 3), Rotation()),
      turnedPolygon(lights, Image(64, 32, 3), kTilt);
  expectTurned(polygon, turnedPolygon, "polygon");
  size_t differing = 0;
  const std::vector<vec3> directions = icosphereNormals(3);
  for (const vec3& d : directions) {
    std::array<Rgb, 2> was{Rgb(0), Rgb(0)}, is{Rgb(0), Rgb(0)};
    whole.splitBackground({}, d, was);
    turned.splitBackground({}, kTilt(d), is);
    differing += std::fabs(is[0].x - was[0].x) > 1e-3f * (was[0].x + was[1].x) ||
                 std::fabs(is[1].x - was[1].x) > 1e-3f * (was[0].x + was[1].x);
  }
  EXPECT_LE(differing, directions.size() / 100);
}

TEST(TiltedProbe, IrradianceTurnsWithTheProbe) {
  const Image map = sunOverSky();
  const ImageSize size{16, 8};
  const Image irradiance = irradianceMap(map, size, kTilt);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const vec3 normal = kTilt.back(vec3(texelDirection(size, x, y)));
      const glm::dvec3 expected = exactIrradiance(map, {&normal, 1})[0];
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(irradiance.rgb(x, y)[k], float(expected[k]), 1e-5f * float(expected[k]));
    }
}

// Resampled by the rotation and seen without it: the same, within the error of resampling.
TEST(TiltedProbe, ConvertTurnsTheMapTheSameWay) {
  const Image map = gradientProbe({256, 128}, Rgb(1, 2, 3), {0.5, 0.4, -0.6});
  for (const Mapping mapping : {Mapping::LatLong, Mapping::VerticalCross, Mapping::AngularMap}) {
    const Image source = convert(map, Mapping::LatLong, mapping, sizeFor(mapping, {256, 128}));
    const Probe baked(convert(source, mapping, Mapping::LatLong, {256, 128}, kTilt));
    const Probe tilted(map, kTilt);
    for (const vec3& d : icosphereNormals(3)) {
      const Rgb a = baked.radiance(d), b = tilted.radiance(d);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 0.01f) << mappingName(mapping);
    }
  }
}

// A scene and its camera turned with the probe look as before: Welch's test for tiles of an image
// from independent seeds.
TEST(SlowTiltedProbe, ASceneTurnedWithItsProbeLooksTheSame) {
  constexpr int kSize = 24, kTile = 8, kTiles = kSize / kTile, kRepeats = 10;
  const Image map = sunOverSky();
  const auto render = [&](const Rotation& rotation, const char* strategy, uint64_t seed) {
    Scene scene;
    const int grey = addMaterial(scene, lambert({0.7f, 0.6f, 0.5f}));
    addQuad(scene, grey, {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
    addSphere(scene, grey, {-0.7f, 0.6f, 0}, 0.6f, 16);
    Material metal;
    metal.roughness = 0.3f;
    addSphere(scene, addMaterial(scene, metal), {0.8f, 0.6f, 0.3f}, 0.6f, 24);
    for (Instance& instance : scene.instances)
      instance.toWorld = Transform{glm::mat3_cast(glm::quat(rotation.quaternion())), vec3(0)};
    const Camera camera = Camera::lookAt(rotation(vec3(0.5f, 2.5f, 4)), rotation(vec3(0, 0.5f, 0)),
                                         rotation(vec3(0, 1, 0)), 0.7f);
    const Probe probe(map, rotation);
    std::vector<std::vector<double>> tiles(kTiles * kTiles);
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      const Image image = renderScene(scene, camera, probe, strategy,
                                      smallRender(kSize, kSize, 32, 3, seed + uint64_t(repeat)))
                              .film.mean();
      for (int i = 0; i < kTiles * kTiles; ++i) {
        double sum = 0;
        for (int k = 0; k < kTile * kTile; ++k)
          sum +=
              luminance(image.rgb(i % kTiles * kTile + k % kTile, i / kTiles * kTile + k / kTile));
        tiles[size_t(i)].push_back(sum);
      }
    }
    return tiles;
  };
  uint64_t seed = 0;
  const std::vector<const char*> strategies{"importance", "suns", "product", "median-cut:16"};
  for (const char* strategy : strategies) {
    const auto level = render(Rotation(), strategy, seed += 1000);
    const auto tilted = render(kTilt, strategy, seed += 1000);
    for (size_t i = 0; i < level.size(); ++i)
      EXPECT_GT(welchTest(Moments::of(level[i]), Moments::of(tilted[i])),
                sidak(1e-3, int(strategies.size() * level.size())))
          << strategy << ", tile " << i;
  }
}

}  // namespace
}  // namespace chromeball::tilted_probe_test
