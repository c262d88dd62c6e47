// SPDX-License-Identifier: Apache-2.0
// --show-lights: how the camera and mirrors see the lights that replace a probe.
#include "lighting/delta_lights.h"

#include <gtest/gtest.h>

#include <fstream>

#include "floor_in_surroundings.h"
#include "image/io/write_image.h"
#include "lighting/area_lights.h"
#include "lighting/methods.h"
#include "probe/synth.h"
#include "run_command.h"
#include "small_model.h"
#include "test_scene.h"

namespace chromeball::shown_lights_test {
namespace {

constexpr float kRotation = 40;

std::unique_ptr<LightSource> shown(const std::string& name, const Probe& probe, bool shows = true) {
  return makeStrategy(name, probe, {Mis::Balance, {}, shows}, "test");
}

// A direction at an angle from `centre`.
vec3 away(const vec3& centre, double degrees) {
  const float angle = float(degrees) * kPi / 180;
  return Frame(centre).toWorld({std::sin(angle), 0, std::cos(angle)});
}

TEST(ShownLights, DeltaLightsAreDiscsOfOneDegreeWithTheirEnergy) {
  const Image map = studioProbe({64, 32});
  const Probe probe(map, kRotation);
  const auto lighting = shown("median-cut:12", probe);
  const auto spots = shownLights(makeLights("median-cut", map, {.count = 12}).lights, kRotation);
  ASSERT_EQ(spots.size(), 12u);
  const double solidAngle = 2 * kPiD * (1 - std::cos(0.5 * kPiD / 180));
  for (const AreaLight& spot : spots) {
    const Rgb inside = lighting->background({}, away(spot.direction, 0.49));
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(inside[k] * solidAngle / double(spot.power[k]), 1, 1e-4);
    EXPECT_EQ(lighting->background({}, away(spot.direction, 0.51)), Rgb(0));
  }
}

TEST(ShownLights, AreaLightsAreDiscsOfTheirSolidAngle) {
  Image map = constantProbe({64, 32}, Rgb(0.01f));
  map.setRgb(20, 9, Rgb(2000, 1000, 500));
  const Probe probe(map, kRotation);
  const RegionAreas areas(
      map, lightMethod("median-cut", "").lights.regions(map, {.count = 32}).partition, kRotation);
  for (const char* name : {"median-cut-area:32", "median-cut-disc:32"}) {
    const auto lighting = shown(name, probe);
    double energy = 0, seen = 0;
    for (const AreaLight& light : areas.lights()) {
      energy += luminance(light.power);
      const double radius = std::acos(1 - light.solidAngle / (2 * kPiD)) * 180 / kPiD;
      // Discs may overlap.
      EXPECT_GE(luminance(lighting->background({}, away(light.direction, 0.99 * radius))),
                0.999f * luminance(light.radiance()));
    }
    constexpr int kSide = 1500;
    for (int i = 0; i < kSide * kSide; ++i) {
      const vec2 u((float(i % kSide) + 0.5f) / kSide, (float(i / kSide) + 0.5f) / kSide);
      seen += luminance(lighting->background({}, squareToUniformSphere(u)));
    }
    EXPECT_NEAR(seen * 4 * kPiD / (double(kSide) * kSide) / energy, 1, 5e-3) << name;
  }
}

// The camera and a mirror see them; matte surfaces are lit as without the option, to the bit.
TEST(ShownLights, AreSeenByTheCameraAndMirrorsOnly) {
  const Probe probe(studioProbe({64, 32}), kRotation);
  const std::atomic<bool> stop = false;
  for (const char* name : {"median-cut:16", "median-cut-area:16", "kollig-keller-average:16"}) {
    SCOPED_TRACE(name);
    const auto with = shown(name, probe), without = shown(name, probe, false);
    const auto image = [&](const Material& material, const LightSource& lighting,
                           const Camera& camera, int size) {
      Scene scene;
      addQuad(scene, addMaterial(scene, material), {-9, 0, 9}, {18, 0, 0}, {0, 0, -18});
      const World world(scene, {}, allTables());
      return render(
                 world, camera, lighting, smallRender(size, size, 64, 2), [](double) {}, stop)
          .film.mean();
    };
    const Camera down = topCamera(3, 60);
    EXPECT_EQ(image(lambert(Rgb(0.5f)), *with, down, 8).texels,
              image(lambert(Rgb(0.5f)), *without, down, 8).texels);
    Material mirror;
    mirror.roughness = 0;
    mirror.doubleSided = true;
    // Both images are of the upper hemisphere: through the mirror, and directly.
    const Camera up = Camera::lookAt({0, 1, 0}, {0, 2, 0}, {0, 0, -1}, kPi / 2);
    const Camera mirrored = Camera::lookAt({0, 1, 0}, {0, 0, 0}, {0, 0, -1}, kPi / 2);
    const Rgb direct = meanColor(image(mirror, *with, up, 64));
    const Rgb reflected = meanColor(image(mirror, *with, mirrored, 64));
    EXPECT_GT(luminance(direct), 0);
    EXPECT_NE(direct, meanColor(image(mirror, *without, up, 64)));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(reflected[k] / direct[k], 1, 0.1);
  }
}

TEST(ShownLights, AreInFrontOfAmbientLight) {
  const Probe probe(constantProbe({16, 8}, Rgb(1, 2, 3)));
  const ShownLights lighting(shown("bsdf", probe, false), {{{0, 1, 0}, Rgb(1), 1e-9}},
                             Rgb(0.5f, 0, 0));
  EXPECT_EQ(lighting.background({}, {0, -1, 0}), Rgb(0.5f, 0, 0));
  EXPECT_GT(lighting.background({}, {0, 1, 0}).y, 1000);
}

// In a room, the lights are where the strategy projects them: seen from the capture point, in
// their directions.
TEST(ShownLights, AreOnTheWallsOfFiniteSurroundings) {
  const Probe probe(spotted(), kRotation);
  const auto distant = shown("median-cut-disc:16", probe);
  const FiniteSurroundings room(shown("median-cut-disc:16", probe), probe, box(), nullptr, true);
  for (uint64_t i = 0; i < 200; ++i) {
    const vec3 wi = sphereDirection(i), capture = box().capture;
    const Rgb expected = distant->background({}, wi);
    EXPECT_LE(glm::length(room.background(capture, wi) - expected), 1e-3f * glm::length(expected));
  }
}

TEST(ShownLights, NeedAStrategyThatHasLights) {
  for (const char* name : {"auto", "bsdf", "uniform", "importance", "product", "suns",
                           "kollig-keller-strata", "kollig-keller-strata:4"})
    EXPECT_FALSE(hasLights(name)) << name;
  for (const char* name :
       {"median-cut", "median-cut:7", "median-cut-area", "median-cut-disc:3", "cube-grid",
        "penrose", "irradiance-fit-ambient:2", "kollig-keller-average"})
    EXPECT_TRUE(hasLights(name)) << name;
}

TEST(ShownLights, InASceneFile) {
  const TemporaryFolder folder;
  writeSmallModel(folder / "a.gltf");
  writeImage(folder / "p.exr", constantProbe({8, 4}, Rgb(1)));
  const auto scene = [&](const char* strategy) {
    std::ofstream(folder / "a.toml") << "model = 'a.gltf'\n[probe]\nfile = 'p.exr'\n[lighting]\n"
                                     << "show_lights = true\nstrategy = '" << strategy << "'\n";
    return std::vector<std::string>{"render", folder / "a.toml", "--size",          "4x4",
                                    "-o",     folder / "a.exr",  "--probe-mapping", "lat-long"};
  };
  expectError(scene("product"), "a.toml:5: the strategy has no lights");
  const CommandResult result = runCommand(scene("median-cut-area:4"));
  EXPECT_EQ(result.status, 0) << result.error;
}

}  // namespace
}  // namespace chromeball::shown_lights_test
