// SPDX-License-Identifier: Apache-2.0
// Sun extraction: the extracted suns, and the energy of suns plus remainder.
#include <gtest/gtest.h>

#include "base/hash.h"
#include "math/icosphere.h"
#include "probe/irradiance.h"
#include "probe/load.h"
#include "probe/mapping.h"
#include "probe/sun_extraction.h"
#include "probe/synth.h"
#include "shared_data.h"

namespace chromeball::sun_extraction_test {
namespace {

const std::vector<vec3>& normals() {
  static const std::vector<vec3> kNormals = icosphereNormals(5);  // 20480
  return kNormals;
}

dvec3 direction(double elevation, double azimuth) {
  return sunDirection({.sunElevation = elevation, .sunAzimuth = azimuth});
}

double degreesBetween(const dvec3& a, const dvec3& b) {
  return 2 * std::asin(glm::distance(a, b) / 2) * 180 / kPiD;
}

double elevationOf(const Sun& sun) { return std::asin(sun.direction.y) * 180 / kPiD; }

// A sun of irradiance 10 in a sky of radiance 0.3 whose glow falls off as 1/angle^2: 50 times that
// at one degree.
void addGlowingSun(Image& image, const dvec3& towards, double diameter) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const dvec3 d =
          *uvToDirection(Mapping::LatLong, {(x + 0.5) / image.width, (y + 0.5) / image.height});
      const double angle = degreesBetween(d, towards);
      const Rgb glow(dvec3(15, 13, 9) / std::max(angle * angle, diameter * diameter));
      image.setRgb(x, y, image.rgb(x, y) + glow);
    }
  addSunDisc(image, towards, diameter, {10, 9, 7});
}

// The radiance that was removed from the map, for parts of texels that are small enough to be
// represented by the direction at their centre.
struct Part {
  dvec3 direction, flux;
};

std::vector<Part> removedParts(const Image& map, const Image& remainder) {
  constexpr int kParts = 5;  // per side
  const int w = map.width, h = map.height;
  std::vector<Part> parts;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const dvec3 removed = dvec3(map.rgb(x, y)) - dvec3(remainder.rgb(x, y));
      if (removed == dvec3(0)) continue;
      for (int j = 0; j < kParts * kParts; ++j) {
        const double px = x * kParts + j % kParts + 0.5, py = y * kParts + j / kParts + 0.5;
        parts.push_back({*uvToDirection(Mapping::LatLong, {px / (w * kParts), py / (h * kParts)}),
                         removed * texelSolidAngle(int(py), w * kParts, h * kParts)});
      }
    }
  return parts;
}

// Difference between the irradiance of suns plus remainder and the map's, averaged over RGB: the
// maximum over the normals, as a percentage of the map's mean irradiance.
double energyError(const Image& map, const SunExtraction& extraction) {
  // Parts are grouped by the nearest sun. If all or none of a group is above the horizon, its first
  // moment gives the irradiance.
  struct Group {
    std::vector<Part> parts;
    dvec3 moment[3] = {dvec3(0), dvec3(0), dvec3(0)};
    double reach = 0;  // chord
  };
  std::vector<Group> groups(extraction.suns.size());
  for (const Part& part : removedParts(map, extraction.remainder)) {
    size_t nearest = 0;
    const auto distance = [&](size_t i) {
      return glm::distance(extraction.suns[i].direction, part.direction);
    };
    for (size_t i = 1; i < groups.size(); ++i)
      if (distance(i) < distance(nearest)) nearest = i;
    Group& group = groups[nearest];
    group.parts.push_back(part);
    group.reach = std::max(group.reach, distance(nearest));
    for (int c = 0; c < 3; ++c) group.moment[c] += part.direction * part.flux[c];
  }
  const dvec3 mean = kPiD * meanRadiance(map);  // of irradiance over all normals
  double worst = 0;
  for (const vec3& n : normals()) {
    const dvec3 normal(n);
    dvec3 error(0);
    for (size_t i = 0; i < groups.size(); ++i) {
      const Sun& sun = extraction.suns[i];
      const double cosine = glm::dot(normal, sun.direction);
      error += sun.irradianceOn(normal);
      if (std::fabs(cosine) > groups[i].reach) {
        for (int c = 0; c < 3 && cosine > 0; ++c) error[c] -= glm::dot(normal, groups[i].moment[c]);
      } else {
        for (const Part& p : groups[i].parts)
          error -= p.flux * std::max(0.0, glm::dot(normal, p.direction));
      }
    }
    error = glm::abs(error);
    worst = std::max(worst, (error.x + error.y + error.z) / (mean.x + mean.y + mean.z));
  }
  return 100 * worst;
}

TEST(Sun, IrradianceOfADiscCutByTheHorizon) {
  for (const double angle : {0.5, 20.0, 100.0}) {
    const Sun sun{glm::normalize(dvec3(1, 2, 3)), dvec3(1, 2, 3), angle};
    const dvec3 radiance = sun.radiance(), x = glm::normalize(glm::cross(sun.direction, {0, 1, 0})),
                y = glm::cross(sun.direction, x);
    for (int tilt = -10; tilt <= 10; ++tilt) {
      const double t = (90 + tilt * angle / 18) * kPiD / 180;
      const dvec3 normal = std::cos(t) * sun.direction + std::sin(t) * x;
      // Heights over the disc are uniform in solid angle.
      constexpr int kRings = 400, kSectors = 400;
      const double cap = 1 - std::cos(angle * kPiD / 360);
      double sum = 0;
      for (int i = 0; i < kRings; ++i)
        for (int j = 0; j < kSectors; ++j) {
          const double z = 1 - cap * (i + 0.5) / kRings, phi = 2 * kPiD * (j + 0.5) / kSectors;
          const double r = std::sqrt(1 - z * z);
          const dvec3 d = z * sun.direction + r * std::cos(phi) * x + r * std::sin(phi) * y;
          sum += std::max(0.0, glm::dot(normal, d));
        }
      const double expected = radiance.y * sum * 2 * kPiD * cap / (kRings * kSectors);
      EXPECT_NEAR(sun.irradianceOn(normal).y, expected, 2e-5) << angle << " " << tilt;
    }
    EXPECT_NEAR(sun.irradianceOn(sun.direction).z, 3, 1e-12);
    EXPECT_EQ(sun.irradianceOn(-sun.direction), dvec3(0));
  }
}

// Elevations, the seam (azimuth 180), both poles.
struct SunPosition {
  double elevation, azimuth;
};
constexpr SunPosition kSunPositions[] = {{2, 180}, {30, 77}, {61, 179.8}, {89.8, 0}, {-90, 0}};

TEST(SunExtraction, KeepsEnergyForEveryNormal) {
  for (const SunPosition& position : kSunPositions) {
    SCOPED_TRACE(testing::Message() << position.elevation << " " << position.azimuth);
    Image map = gradientProbe({1024, 512}, Rgb(0.2f, 0.25f, 0.3f), {0.1, 0.6, -0.2});
    const dvec3 towards = direction(position.elevation, position.azimuth);
    addGlowingSun(map, towards, 0.7);
    const SunExtraction extraction = extractSuns(map);
    ASSERT_EQ(extraction.suns.size(), 1u);
    EXPECT_LT(degreesBetween(extraction.suns[0].direction, towards), 0.05);
    EXPECT_LT(energyError(map, extraction), 0.1);
  }
}

// The disc has the spread of the removed texels, not their shape.
TEST(SunExtraction, KeepsEnergyInCoarseMaps) {
  struct Bound {
    ImageSize size;
    double percent;
  };
  for (const auto& [size, percent] : {Bound{{256, 128}, 0.5}, Bound{{64, 32}, 2}}) {
    for (int i = 0; i < 40; ++i) {
      const double elevation = 5 + 80 * toUnit(uint32_t(hash(uint64_t(i), 1))),
                   azimuth = 360 * toUnit(uint32_t(hash(uint64_t(i), 2))) - 180;
      SCOPED_TRACE(testing::Message() << size.width << " " << elevation << " " << azimuth);
      const Image map = clearSkyProbe(size, {.sunElevation = elevation, .sunAzimuth = azimuth});
      const SunExtraction extraction = extractSuns(map);
      ASSERT_EQ(extraction.suns.size(), 1u);
      EXPECT_LT(energyError(map, extraction), percent);
    }
  }
}

TEST(SunExtraction, MeasuresDiscs) {
  for (const SunPosition& position : kSunPositions)
    for (const double diameter : {0.5323, 4.0}) {
      SCOPED_TRACE(testing::Message() << position.elevation << " " << diameter);
      Image map = constantProbe({1024, 512}, Rgb(0.01f));
      const dvec3 towards = direction(position.elevation, position.azimuth);
      addSunDisc(map, towards, diameter, {1, 2, 3});
      const SunExtraction extraction = extractSuns(map);
      ASSERT_EQ(extraction.suns.size(), 1u);
      const Sun& sun = extraction.suns[0];
      EXPECT_LT(degreesBetween(sun.direction, towards), 0.02);
      // The blur by texels adds almost in quadrature.
      const double texel = 180.0 / 512;
      EXPECT_NEAR(sun.angle, std::sqrt(diameter * diameter + 1.3 * texel * texel), 0.1);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(sun.irradiance[c], c + 1, 1e-3 * (c + 1));
      EXPECT_NEAR(sun.radiance().x,
                  sun.irradiance.x / (kPiD * std::pow(std::sin(sun.angle * kPiD / 360), 2)),
                  1e-6 * sun.radiance().x);
    }
}

TEST(SunExtraction, RemovesTheGlowAndNothingElse) {
  Image map = gradientProbe({512, 256}, Rgb(0.3f), {0, 0.5, 0});
  const dvec3 towards = direction(25, 180);
  addGlowingSun(map, towards, 1);
  const Image remainder = extractSuns(map).remainder;
  const double mean = luminance(Rgb(meanRadiance(map)));
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 512; ++x) {
      const Rgb before = map.rgb(x, y), after = remainder.rgb(x, y);
      ASSERT_TRUE(glm::all(glm::lessThanEqual(after, before)));
      ASSERT_LT(luminance(after), 30 * mean);
      const dvec3 d = *uvToDirection(Mapping::LatLong, {(x + 0.5) / 512, (y + 0.5) / 256});
      if (degreesBetween(d, towards) > 7) {
        ASSERT_EQ(after, before);
      }
    }
}

TEST(SunExtraction, TwoSunsAndAPartlyOccludedOne) {
  for (const double distance : {4.0, 40.0}) {
    Image map = constantProbe({1024, 512}, Rgb(0.1f));
    addSunDisc(map, direction(30, 0), 0.6, dvec3(4));
    addSunDisc(map, direction(30 + distance, 0), 0.6, {8, 6, 1});
    const SunExtraction extraction = extractSuns(map);
    ASSERT_EQ(extraction.suns.size(), 2u);
    EXPECT_NEAR(elevationOf(extraction.suns[0]), 30 + distance, 0.05);
    EXPECT_NEAR(elevationOf(extraction.suns[1]), 30, 0.05);
    EXPECT_LT(energyError(map, extraction), 0.1);
  }
  Image map = constantProbe({1024, 512}, Rgb(0.1f));
  addSunDisc(map, direction(30, 0), 2, dvec3(9));
  for (int x = 0; x < 1024; ++x) map.setRgb(x, 170, Rgb(0.02f));
  const SunExtraction extraction = extractSuns(map);
  ASSERT_EQ(extraction.suns.size(), 1u);
  EXPECT_NEAR(extraction.suns[0].angle, 2, 0.4);
  EXPECT_LT(luminance(extraction.remainder.rgb(512, 168)), 0.11f);
  EXPECT_EQ(extraction.remainder.rgb(512, 170), Rgb(0.02f));
}

TEST(SunExtraction, FindsNoneWithoutSuns) {
  EXPECT_TRUE(extractSuns(constantProbe({64, 32}, Rgb(3))).suns.empty());
  EXPECT_TRUE(extractSuns(constantProbe({64, 32}, Rgb(0))).suns.empty());
  EXPECT_TRUE(extractSuns(constantProbe({1, 1}, Rgb(3))).suns.empty());
  EXPECT_TRUE(extractSuns(overcastProbe({256, 128}, Rgb(1), 0.2)).suns.empty());
  EXPECT_TRUE(extractSuns(gradientProbe({256, 128}, Rgb(1), {0, 1, 0})).suns.empty());
  for (const int width : {64, 256})
    EXPECT_TRUE(extractSuns(studioProbe({width, width / 2})).suns.empty()) << width;
  Image spark = constantProbe({1024, 512}, Rgb(1));
  spark.setRgb(300, 200, Rgb(2500));  // 0.7% of the flux
  EXPECT_TRUE(extractSuns(spark).suns.empty());
  EXPECT_EQ(extractSuns(spark).remainder.texels, spark.texels);
  Image panel = constantProbe({64, 32}, Rgb(0.1f));  // 70 times the mean, but 28 degrees wide
  for (int i = 0; i < 20; ++i) panel.setRgb(30 + i % 5, 14 + i / 5, Rgb(100));
  EXPECT_TRUE(extractSuns(panel).suns.empty());
  EXPECT_TRUE(extractSuns(clearSkyProbe({256, 128}, {.sunElevation = 20}, false)).suns.empty());
}

// Of texels as wide as the sky no disc has the light.
TEST(SunExtraction, ElongatedMapsKeepTheirLight) {
  for (const ImageSize size : {ImageSize{1, 64}, {1, 4096}, {4096, 1}, {64, 1}, {3, 5}}) {
    SCOPED_TRACE(testing::Message() << size.width << " x " << size.height);
    Image map(size.width, size.height, 3);
    for (int i = 0; i < size.width * size.height; ++i)
      map.setRgb(i % size.width, i / size.width,
                 Rgb(0.05f + 0.2f * toUnit(uint32_t(hash(uint64_t(i))))));
    map.setRgb(size.width / 2, size.height / 2, Rgb(5));
    const SunExtraction found = extractSuns(map);
    const std::vector<vec3> up{{0, 1, 0}};
    double irradiance = exactIrradiance(found.remainder, up)[0].y;
    for (const Sun& sun : found.suns) irradiance += sun.irradianceOn(dvec3(up[0])).y;
    EXPECT_NEAR(irradiance / exactIrradiance(map, up)[0].y, 1, 0.05);
  }
}

// In maps of any shape, one bright texel becomes a disc of finite radiance with its energy.
TEST(SunExtraction, OneTexelOfAnyMap) {
  for (const ImageSize size : {ImageSize{2, 1}, {3, 16}, {64, 2}, {64, 32}, {300, 20}, {512, 256}})
    for (const int y : {0, size.height / 2, size.height - 1}) {
      SCOPED_TRACE(testing::Message() << size.width << " x " << size.height << ", row " << y);
      const SunExtraction extraction = extractSuns(oneHotProbe(size, 0, y, Rgb(1e5f)));
      const double flux = 1e5 * texelSolidAngle(y, size.width, size.height);
      const double kept = 4 * kPiD * meanRadiance(extraction.remainder).y;
      if (extraction.suns.empty()) {
        EXPECT_NEAR(kept / flux, 1, 1e-6);
        continue;
      }
      const Sun& sun = extraction.suns[0];
      EXPECT_NEAR(glm::length(sun.direction), 1, 1e-12);
      EXPECT_GT(sun.angle, 0);
      EXPECT_LE(sun.angle, 90);
      EXPECT_LE(sun.irradiance.y, flux);
      EXPECT_EQ(kept, 0);
      if (size.width >= 64 && size.height >= 32) {
        EXPECT_GT(sun.irradiance.y, 0.99 * flux);
      }
    }
}

// Elevations and irradiances measured by another program, from the notes stored with the data.
// Directions point to the brightest texel's centre; irradiances include the sky within two degrees.
TEST(SunExtraction, SunsOfRealProbes) {
  struct Known {
    const char* file;
    double elevation, irradiance;
  };
  const Known kSuns[] = {
      {"hilly_terrain_01_1k", 11.4, 2.46},           {"kloppenheim_05_1k", 74.7, 6.66},
      {"narrow_moonlit_road_1k", 67.7, 2.82},        {"pmndrs_sunrise", 7.9, 12.4},
      {"qwantani_afternoon_puresky_1k", 41.0, 8.41}, {"venice_sunset_1k", 3.3, 0.161}};
  for (const Known& known : kSuns) {
    SCOPED_TRACE(known.file);
    const auto path = sharedData(std::string("probes/polyhaven/") + known.file + ".hdr");
    if (!path) GTEST_SKIP() << "no probes";
    const Image map = loadProbe(*path).latLong;
    const SunExtraction extraction = extractSuns(map);
    ASSERT_EQ(extraction.suns.size(), 1u);
    const Sun& sun = extraction.suns[0];
    EXPECT_NEAR(elevationOf(sun), known.elevation, 0.2);
    EXPECT_NEAR(luminance(Rgb(sun.irradiance)) / known.irradiance, 1, 0.1);
    EXPECT_GT(sun.angle, 0.5);
    EXPECT_LT(sun.angle, 1.2);
    EXPECT_LT(energyError(map, extraction), 0.1);
  }
  const auto spot = sharedData("probes/synthetic/spot1Lux.hdr");
  if (!spot) GTEST_SKIP() << "no probes";
  const std::vector<Sun> suns = extractSuns(loadProbe(*spot).latLong).suns;
  ASSERT_EQ(suns.size(), 1u);
  EXPECT_NEAR(suns[0].irradiance.x, 0.9592, 1e-4);
}

TEST(SunExtraction, RealProbesWithoutSuns) {
  for (const char* file :
       {"polyhaven/studio_small_05_1k.hdr", "polyhaven/pmndrs_lobby.hdr",
        "debevec/galileo_probe.hdr", "misc/mitsuba_museum.exr",
        "probulator/uffizi_latlong_small.hdr", "probulator/pisa_latlong_small.hdr"}) {
    const auto path = sharedData(std::string("probes/") + file);
    if (!path) GTEST_SKIP() << "no probes";
    EXPECT_TRUE(extractSuns(loadProbe(*path).latLong).suns.empty()) << file;
  }
}

// Compares with the independent sums of irradiance.h, which treat a texel on the horizon as a
// point.
TEST(SlowSunExtraction, AgreesWithExactIrradiance) {
  const std::vector<vec3> someNormals = icosphereNormals(4);
  for (const double elevation : {8.0, 45.0, 75.0}) {
    const Image map = clearSkyProbe({2048, 1024}, {.sunElevation = elevation});
    const SunExtraction extraction = extractSuns(map);
    ASSERT_EQ(extraction.suns.size(), 1u);
    Image removed = map;
    for (size_t i = 0; i < map.texels.size(); ++i)
      removed.texels[i] -= extraction.remainder.texels[i];
    const std::vector<dvec3> irradiance = exactIrradiance(removed, someNormals);
    const double mean = kPiD * luminance(Rgb(meanRadiance(map)));
    for (size_t i = 0; i < irradiance.size(); ++i) {
      const dvec3 sun = extraction.suns[0].irradianceOn(dvec3(someNormals[i]));
      ASSERT_NEAR(luminance(Rgb(sun - irradiance[i])), 0, 1e-3 * mean);
    }
  }
}

}  // namespace
}  // namespace chromeball::sun_extraction_test
