// SPDX-License-Identifier: Apache-2.0
// Properties that all constellation methods share, such as conservation of the map's energy.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "constellation_maps.h"
#include "lighting/constellation/texel_table.h"
#include "probe/mapping.h"
#include "probe/synth.h"

namespace chromeball::constellation_test {
namespace {

int litTexels(const Image& map) {
  int lit = 0;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) lit += !isBlack(map.rgb(x, y));
  return lit;
}

// Checks the energy of each channel, unit directions, and that no light is black or negative.
void expectValid(const Constellation& lights, const Image& map) {
  dvec3 sum(0);
  for (const DirectionalLight& light : lights) {
    EXPECT_NEAR(glm::length(light.direction), 1, 1e-6);
    EXPECT_TRUE(isFinite(light.irradiance));
    EXPECT_GE(std::min({light.irradiance.x, light.irradiance.y, light.irradiance.z}), 0);
    EXPECT_FALSE(isBlack(light.irradiance));
    sum += dvec3(light.irradiance);
  }
  const dvec3 expected = meanRadiance(map) * 4.0 * kPiD;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], expected[c], 1e-5 * expected[c]);
}

Image sunOverGrey() {
  Image map = constantProbe({48, 24}, Rgb(0.25f, 0.5f, 1));
  map.setRgb(11, 7, Rgb(1e12f, 8e11f, 5e11f));
  return map;
}

TEST(Constellation, ConservesEnergyAndHasTheRequestedCount) {
  const std::vector<std::pair<const char*, Image>> maps = {
      {"constant", constantProbe({48, 24}, Rgb(1, 2, 3))},
      {"one-hot", oneHotProbe({48, 24}, 5, 9, Rgb(3, 0, 1))},
      {"gradient", gradientProbe({48, 24}, Rgb(1, 2, 0.5f), {0.3, -0.6, 0.4})},
      {"sun", sunOverGrey()},
      {"black", Image(48, 24, 3)},
      {"1 x 1", constantProbe({1, 1}, Rgb(1, 2, 3))},
      {"2 x 1", constantProbe({2, 1}, Rgb(1, 2, 3))},
      {"1 x 40", noise(1, 40)},
      {"not 2:1", noise(37, 53)},
      {"four channels", Image(8, 4, 4)}};
  for (const auto& [name, map] : maps)
    for (const std::string_view method : constellationNames())
      for (const int count : {2, 3, 7, 64, 300, 1000}) {
        SCOPED_TRACE(fmt::format("{} {}:{}", name, method, count));
        const Constellation lights = make(method, map, count);
        expectValid(lights, map);
        const int lit = litTexels(map), n = countFor(method, count);
        if (method == "cube-grid")
          EXPECT_LE(int(lights.size()), std::min(6 * n * n, lit));
        else if (method == "penrose")
          EXPECT_EQ(int(lights.size()), lit > 0 ? n : 0);
        else
          EXPECT_EQ(int(lights.size()), std::min(n, lit));
      }
}

TEST(SlowConstellation, ConservesEnergyOfRealProbes) {
  const std::vector<Image> maps = realProbes(3);
  if (maps.empty()) GTEST_SKIP() << "no shared probes";
  for (const Image& map : maps)
    for (const std::string_view method : constellationNames())
      for (const int count : {2, 64}) {
        SCOPED_TRACE(fmt::format("{}:{}", method, count));
        const Constellation lights = make(method, map, count);
        expectValid(lights, map);
        if (method != "cube-grid") {
          EXPECT_EQ(int(lights.size()), count);
        }
      }
}

TEST(Constellation, LightsAreDeterminedByTheSeed) {
  const Image map = noise(64, 32);
  const auto same = [](const Constellation& a, const Constellation& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const DirectionalLight& l, const DirectionalLight& m) {
                        return l.direction == m.direction && l.irradiance == m.irradiance;
                      });
  };
  for (const std::string_view method : constellationNames()) {
    EXPECT_TRUE(same(make(method, map, 50, 3), make(method, map, 50, 3))) << method;
    const bool isStochastic = lightMethod(method, "test").lights.isStochastic;
    EXPECT_EQ(same(make(method, map, 50, 3), make(method, map, 50, 4)), !isStochastic) << method;
  }
}

TEST(Constellation, RejectsInvalidMethodsAndCounts) {
  const Image map = constantProbe({8, 4}, Rgb(1));
  try {
    makeLights("medain-cut", map, {.count = 8});
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean `median-cut`?"), std::string::npos);
  }
  for (const int count : {-1, 0, 1, 4097})
    EXPECT_THROW(makeLights("median-cut", map, {.count = count}), InputError);
  for (const int count : {-1, 0, 27})
    EXPECT_THROW(makeLights("cube-grid", map, {.count = count}), InputError);
  EXPECT_THROW(makeLights("median-cut", map, {}), InputError) << "a count is missing";
  EXPECT_THROW(makeLights("suns", map, {.count = 0}), InputError);
  EXPECT_THROW(makeLights("importance", map, {.count = 8}), InputError) << "makes no lights";
  Image broken = map;
  broken.at(3, 2)[1] = std::nanf("");
  EXPECT_THROW(makeLights("median-cut", broken, {.count = 8}), InputError);
  broken.at(3, 2)[1] = -1;
  EXPECT_THROW(makeLights("penrose", broken, {.count = 8}), InputError);
  EXPECT_THROW(makeLights("penrose", Image(), {.count = 8}), InputError);
  EXPECT_THROW(makeLights("lightgen", Image(8, 4, 1), {.count = 8}), InputError);
  EXPECT_THROW(makeLights("lightgen", constantProbe({8, 4}, Rgb(3e38f)), {.count = 8}), InputError);
}

// The left half of the map is the hemisphere x < 0.
TEST(Constellation, ColoursStayInTheirHemisphere) {
  Image map(64, 32, 3);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x) map.setRgb(x, y, x < 32 ? Rgb(4, 0, 0) : Rgb(0, 0, 4));
  for (const std::string_view method : constellationNames()) {
    dvec3 left(0), right(0);
    for (const DirectionalLight& light : make(method, map, 400))
      (light.direction.x < 0 ? left : right) += dvec3(light.irradiance);
    EXPECT_GT(left.x, 10 * left.z) << method;
    EXPECT_GT(right.z, 10 * right.x) << method;
  }
}

TEST(Constellation, SumsLargeMapsInBlocks) {
  const Image map = noise(2113, 1057);
  EXPECT_EQ(TexelTable(map, kFineCells).block(), 2);
  for (const std::string_view method : {"median-cut", "variance-cut", "cube-grid", "penrose"}) {
    SCOPED_TRACE(method);
    expectValid(make(method, map, 100), map);
  }
}

// variance-cut may put the sun into one region with its neighbouring texels.
TEST(Constellation, ASunDoesNotAbsorbTheEnergyOfItsRow) {
  Image map = noise(16384, 16);
  const dvec3 rest = meanRadiance(map) * 4.0 * kPiD;
  map.setRgb(100, 8, Rgb(1e12f));
  for (const auto& [method, tolerance] : {std::pair("median-cut", 1e-5), {"variance-cut", 0.01}}) {
    dvec3 sum(0);
    const Constellation lights = make(method, map, 300);
    EXPECT_EQ(lights.size(), 300u);
    for (const DirectionalLight& light : lights)
      if (light.irradiance.x < 1000) sum += dvec3(light.irradiance);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], rest[c], tolerance * rest[c]) << method;
  }
}

// Rotating the map by 90 degrees rotates the lights.
TEST(Constellation, RotatesWithTheMap) {
  const Image map = noise(64, 32);
  Image turned(64, 32, 3);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x) turned.setRgb((x + 16) % 64, y, map.rgb(x, y));
  // u grows by 1/4: (x, z) = (-sin 2 pi u, cos 2 pi u) becomes (-z, x).
  for (const std::string_view method : {"kollig-keller", "cube-grid"}) {
    const Constellation before = make(method, map, 54), after = make(method, turned, 54);
    ASSERT_EQ(before.size(), after.size());
    for (const DirectionalLight& light : before) {
      const vec3 d(-light.direction.z, light.direction.y, light.direction.x);
      float nearest = 9;
      Rgb irradiance(0);
      for (const DirectionalLight& other : after)
        if (const float distance = glm::distance(d, other.direction); distance < nearest)
          nearest = distance, irradiance = other.irradiance;
      EXPECT_LT(nearest, 1e-5) << method;
      EXPECT_LT(glm::distance(irradiance, light.irradiance), 1e-4f * glm::length(irradiance))
          << method;
    }
  }
}

}  // namespace
}  // namespace chromeball::constellation_test
