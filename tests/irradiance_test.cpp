// SPDX-License-Identifier: Apache-2.0
// Exact irradiance against closed forms, a sum in double, and published references; spherical
// harmonics against both.
#include "probe/irradiance.h"

#include <gtest/gtest.h>

#include <random>

#include "base/parallel.h"
#include "image/io/read_image.h"
#include "math/icosphere.h"
#include "probe/load.h"
#include "probe/synth.h"
#include "shared_data.h"

namespace chromeball::irradiance_test {
namespace {

TEST(Icosphere, NormalsAreSpreadEvenly) {
  EXPECT_EQ(icosphereNormals(0).size(), 20u);
  const std::vector<vec3> normals = icosphereNormals(5);
  ASSERT_EQ(normals.size(), 20480u);
  dvec3 sum(0);
  glm::dmat3 moments(0);
  for (const vec3& n : normals) {
    EXPECT_NEAR(length(n), 1, 2e-7);
    sum += dvec3(n);
    moments += outerProduct(dvec3(n), dvec3(n));
  }
  EXPECT_LT(length(sum), 1e-3);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(moments[i][j] / 20480, i == j ? 1. / 3 : 0, 1e-7);
}

TEST(Icosphere, DistancesBetweenNeighboursAreBounded) {
  const std::vector<vec3> normals = icosphereNormals(3);
  const double spacing = std::sqrt(4 * kPiD / double(normals.size()));  // a square's side
  for (const vec3& a : normals) {
    double nearest = 9;
    for (const vec3& b : normals)
      if (&a != &b) nearest = std::min(nearest, double(distance(a, b)));
    EXPECT_GT(nearest, 0.5 * spacing);
    EXPECT_LT(nearest, 1.1 * spacing);
  }
}

// This holds also if the map is a single texel, or a single row: only the rows that the horizon
// cuts make the sum too small.
TEST(Irradiance, OfAConstantMap) {
  const std::vector<vec3> normals = icosphereNormals(2);
  for (const ImageSize& size : {ImageSize{1, 1},
                                {2, 1},
                                {1000, 1},
                                {1, 1000},
                                {3, 2},
                                {4, 2},
                                {5, 3},
                                {32, 16},
                                {33, 17},
                                {128, 64},
                                {512, 256}}) {
    const Rgb radiance(0.5f, 1, 2);
    for (const dvec3& e : exactIrradiance(constantProbe(size, radiance), normals))
      for (int c = 0; c < 3; ++c) {
        EXPECT_LT(e[c] / (kPiD * radiance[c]) - 1, 1e-12) << size.width << " x " << size.height;
        EXPECT_GT(e[c] / (kPiD * radiance[c]) - 1, -6e-5) << size.width << " x " << size.height;
      }
  }
}

TEST(Irradiance, OfAGradient) {
  const std::vector<vec3> normals = icosphereNormals(2);
  const dvec3 slope(0.4, -0.7, 0.5);
  const auto irradiance = exactIrradiance(gradientProbe({1024, 512}, Rgb(3), slope), normals);
  for (size_t i = 0; i < normals.size(); ++i)
    EXPECT_NEAR(irradiance[i].x, 3 * kPiD * (1 + 2. / 3 * dot(slope, dvec3(normals[i]))), 1e-4);
}

TEST(Irradiance, OfALitHemisphere) {
  Image sky(256, 128, 3);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 256; ++x) sky.setRgb(x, y, Rgb(1));
  const std::vector<vec3> normals = icosphereNormals(2);
  const auto irradiance = exactIrradiance(sky, normals);
  for (size_t i = 0; i < normals.size(); ++i)
    EXPECT_NEAR(irradiance[i].x, kPiD / 2 * (1 + normals[i].y), 2e-4);
  // The horizon of these normals cuts no texel, so the sum is exact for any map size.
  Image coarse(4, 2, 3);
  for (int x = 0; x < 4; ++x) coarse.setRgb(x, 0, Rgb(1));
  const std::vector<vec3> upAndDown{{0, 1, 0}, {0, -1, 0}};
  EXPECT_NEAR(exactIrradiance(coarse, upAndDown)[0].x, kPiD, 5e-7);
  EXPECT_EQ(exactIrradiance(coarse, upAndDown)[1].x, 0);
}

// The integral of direction over a texel, from the antiderivatives.
dvec3 texelMoment(int x, int y, int width, int height) {
  const double theta0 = kPiD * y / height, theta1 = kPiD * (y + 1) / height;
  const double phi0 = 2 * kPiD * x / width, phi1 = 2 * kPiD * (x + 1) / width;
  const auto sineSquared = [](double theta) { return theta / 2 - std::sin(2 * theta) / 4; };
  const double horizontal = sineSquared(theta1) - sineSquared(theta0);
  // u = 0 shows +Z, and u grows towards -X.
  return {horizontal * (std::cos(phi1) - std::cos(phi0)),
          (phi1 - phi0) * (std::pow(std::sin(theta1), 2) - std::pow(std::sin(theta0), 2)) / 2,
          horizontal * (std::sin(phi1) - std::sin(phi0))};
}

// The same sum over parts of texels, each entirely above the horizon or entirely below it.
dvec3 sumOverCells(const Image& map, const vec3& normal, int perTexel) {
  dvec3 sum(0);
  for (int y = 0; y < perTexel * map.height; ++y)
    for (int x = 0; x < perTexel * map.width; ++x) {
      const Rgb radiance = map.rgb(x / perTexel, y / perTexel);
      if (isBlack(radiance)) continue;
      const dvec3 moment = texelMoment(x, y, perTexel * map.width, perTexel * map.height);
      sum += dvec3(radiance) * std::max(0.0, dot(moment, dvec3(normal)));
    }
  return sum;
}

TEST(Irradiance, OfOneTexelAnywhere) {
  const std::vector<vec3> normals = icosphereNormals(1);
  for (const auto& [x, y] : {std::pair{0, 0}, {7, 3}, {3, 1}, {7, 2}, {0, 3}}) {
    const Image map = oneHotProbe({8, 4}, x, y, Rgb(1, 10, 1e6f));
    const auto irradiance = exactIrradiance(map, normals);
    for (size_t i = 0; i < normals.size(); ++i) {
      const double expected = sumOverCells(map, normals[i], 64).x;
      EXPECT_NEAR(irradiance[i].x, expected, 3e-5);
      EXPECT_NEAR(irradiance[i].z, 1e6 * irradiance[i].x, 1e-6);
    }
  }
}

// Texels that the horizon does not cut enter exactly.
TEST(Irradiance, OfAMapThatTheHorizonDoesNotCut) {
  Image map(8, 4, 3);
  for (int x = 0; x < 8; ++x)
    for (int y = 0; y < 2; ++y) map.setRgb(x, y, Rgb(float(x + 1), float(1 + x * y), 1e-3f));
  const vec3 up(0, 1, 0);
  const dvec3 expected = sumOverCells(map, up, 1);
  const dvec3 irradiance = exactIrradiance(map, {&up, 1})[0];
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(irradiance[c] / expected[c], 1, 1e-14);
}

// Far from a sun, little light remains exact.
TEST(Irradiance, OfFaintLightBesideASunBehind) {
  Image map = constantProbe({64, 32}, Rgb(1e-8f));
  const vec3 away(-texelDirection({64, 32}, 10, 12));
  const double faint = exactIrradiance(map, {&away, 1})[0].x;
  map.setRgb(10, 12, Rgb(1e10f));
  EXPECT_NEAR(exactIrradiance(map, {&away, 1})[0].x / faint, 1, 1e-12);
}

// A map whose texels span ten orders of magnitude.
Image highRangeProbe(const ImageSize& size) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> exponent(-4, 6);
  Image image(size.width, size.height, 3);
  for (float& channel : image.texels) channel = std::pow(10.0f, exponent(random));
  return image;
}

TEST(Irradiance, AgreesWithASumOverPartsOfTexels) {
  const Image map = highRangeProbe({96, 48});
  const std::vector<vec3> normals = icosphereNormals(0);
  const auto irradiance = exactIrradiance(map, normals);
  for (size_t i = 0; i < normals.size(); ++i) {
    const dvec3 expected = sumOverCells(map, normals[i], 8);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(irradiance[i][c] / expected[c], 1, 1e-4);
  }
}

TEST(Irradiance, IsIndependentOfThreadsAndOtherNormals) {
  const Image probe = highRangeProbe({64, 32});
  const std::vector<vec3> normals = icosphereNormals(3);
  const auto together = exactIrradiance(probe, normals);
  {
    const ThreadLimit one(1);
    EXPECT_EQ(exactIrradiance(probe, normals), together);
  }
  for (const size_t count : {size_t(0), size_t(1), size_t(17)}) {
    const auto few = exactIrradiance(probe, std::span(normals).last(count));
    EXPECT_EQ(few, std::vector<dvec3>(together.end() - count, together.end()));
  }
}

TEST(Irradiance, OfABlackMapIsZero) {
  for (const dvec3& e : exactIrradiance(constantProbe({8, 4}, Rgb(0)), icosphereNormals(0)))
    EXPECT_EQ(e, dvec3(0));
}

TEST(Irradiance, MapIsAtTexelCentres) {
  const Image probe = highRangeProbe({16, 8});
  const Image map = irradianceMap(probe, {12, 6});
  ASSERT_EQ(map.texels.size(), 12u * 6 * 3);
  const dvec3 direction = *uvToDirection(Mapping::LatLong, {7.5 / 12, 1.5 / 6});
  const vec3 normal(direction);
  EXPECT_EQ(map.rgb(7, 1), Rgb(exactIrradiance(probe, std::span(&normal, 1)).front()));
  EXPECT_EQ(shIrradianceMap(probe, {12, 6}).rgb(7, 1),
            Rgb(shIrradiance(projectSh(probe), dvec3(normal))));
}

TEST(Irradiance, OfThePointSourceOfOneLux) {
  const auto path = sharedData("probes/synthetic/spot1Lux.hdr");
  if (!path) GTEST_SKIP() << "no probes/synthetic/spot1Lux.hdr";
  const Image probe = loadProbe(*path).latLong;
  const dvec3 source = *uvToDirection(Mapping::LatLong, {597.5 / 1024, 213.5 / 512});
  const std::vector<vec3> normals{vec3(source), vec3(-source)};
  const auto irradiance = exactIrradiance(probe, normals);
  EXPECT_NEAR(irradiance[0].y, 0.9592, 5e-5);
  EXPECT_EQ(irradiance[1].y, 0);
}

// The polynomial of Ramamoorthi and Hanrahan 2001, eq. 13, with its printed constants. Its z axis
// is reversed; that changes no term because coefficients and direction change together.
TEST(ShIrradiance, EqualsThePublishedPolynomial) {
  const ShCoefficients l = projectSh(studioProbe({64, 32}));
  const double c1 = 0.429043, c2 = 0.511664, c3 = 0.743125, c4 = 0.886227, c5 = 0.247708;
  for (const vec3& n : icosphereNormals(1)) {
    const double x = n.x, y = n.y, z = n.z;
    const dvec3 expected = c1 * l[8] * (x * x - y * y) + c3 * l[6] * z * z + c4 * l[0] - c5 * l[6] +
                           2 * c1 * (l[4] * x * y + l[7] * x * z + l[5] * y * z) +
                           2 * c2 * (l[3] * x + l[1] * y + l[2] * z);
    const dvec3 irradiance = shIrradiance(l, dvec3(n));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(irradiance[c], expected[c], 1e-4);
  }
}

// Mean over the normals of |SH - exact|, divided by the mean of the exact irradiance.
double shError(const Image& probe, std::span<const vec3> normals) {
  const auto exact = exactIrradiance(probe, normals), sh = shIrradiance(probe, normals);
  double difference = 0, sum = 0;
  for (size_t i = 0; i < normals.size(); ++i) {
    difference += std::fabs(sh[i].y - exact[i].y);
    sum += exact[i].y;
  }
  return difference / sum;
}

TEST(ShIrradiance, OfAGradientIsExact) {
  EXPECT_LT(shError(gradientProbe({256, 128}, Rgb(1), {0.3, 0.5, -0.4}), icosphereNormals(2)),
            2e-4);
}

// Bands above 2 contribute little to the irradiance of a smooth probe, and much to a sun's.
TEST(ShIrradiance, IsAccurateToOnePercentOnSmoothProbesButNotUnderASun) {
  const std::vector<vec3> normals = icosphereNormals(3);
  const ClearSky sky{.sunElevation = 30};
  EXPECT_LT(shError(overcastProbe({128, 64}, Rgb(1), 0.2), normals), 0.01);
  EXPECT_LT(shError(clearSkyProbe({128, 64}, sky, false), normals), 0.01);
  EXPECT_GT(shError(clearSkyProbe({128, 64}, sky), normals), 0.03);
}

// For a single sun the result is E (1/4 + c/2 + 5 (3 c^2 - 1)/32), with c the cosine to it:
// negative at c = -8/15.
TEST(ShIrradiance, IsNegativeNextToASun) {
  const dvec3 sun = normalize(dvec3(1, 2, 3)), side = normalize(cross(sun, dvec3(0, 1, 0)));
  Image probe = constantProbe({256, 128}, Rgb(0.01f));
  addSunDisc(probe, sun, kSunDiameter, dvec3(3));
  const double c = -8. / 15;
  const std::vector<vec3> normals{vec3(c * sun + std::sqrt(1 - c * c) * side)};
  const double expected = 0.01 * kPiD + 3 * (0.25 + c / 2 + 5. / 32 * (3 * c * c - 1));
  EXPECT_LT(expected, -0.05);
  EXPECT_NEAR(shIrradiance(probe, normals)[0].y, expected, 1e-3);
  EXPECT_NEAR(exactIrradiance(probe, normals)[0].y, 0.01 * kPiD, 1e-4);
}

// On captured probes, nine coefficients lose little energy, but the error is larger.
TEST(SlowShIrradiance, OfRealProbesHasSmallEnergyLossAndAnErrorOfPercents) {
  int probes = 0;
  double minimum = 1, maximum = 0;
  const std::vector<vec3> normals = icosphereNormals(3);
  for (const char* name :
       {"debevec/galileo_probe.hdr", "debevec/stpeters_cross.hdr", "polyhaven/pmndrs_sunrise.hdr",
        "polyhaven/venice_sunset_1k.hdr", "polyhaven/qwantani_afternoon_puresky_1k.hdr",
        "probulator/ennis_latlong_small.hdr"}) {
    const auto path = sharedData(std::string("probes/") + name);
    if (!path) continue;
    ++probes;
    const Image latLong = loadProbe(*path).latLong;
    const std::vector<dvec3> exact = exactIrradiance(latLong, normals);
    const std::vector<dvec3> sh = shIrradiance(latLong, normals);
    double sum = 0, error = 0, energy = 0, lost = 0;
    for (size_t i = 0; i < normals.size(); ++i) {
      const double e = luminance(Rgb(exact[i])), off = luminance(Rgb(sh[i] - exact[i]));
      sum += e, error += std::fabs(off), energy += e * e, lost += off * off;
    }
    EXPECT_LT(lost / energy, 0.01) << name;
    minimum = std::min(minimum, error / sum), maximum = std::max(maximum, error / sum);
  }
  if (probes < 6) GTEST_SKIP() << "no real probes";
  EXPECT_NEAR(minimum, 0.011, 0.002);
  EXPECT_NEAR(maximum, 0.10, 0.01);
}

// Probulator's references: irradiance / pi, linear, 8 bits, rounded down. Its Monte Carlo uses the
// same 5000 samples for all normals (accurate to about 2%), its spherical harmonics 20000.
TEST(SlowIrradiance, PublishedImages) {
  int compared = 0;
  for (const std::string name : {"Ennis", "Grace", "Pisa", "Uffizi", "Wells"}) {
    std::string file = name + "_latlong_small.hdr";
    file[0] = char(file[0] - 'A' + 'a');
    const auto path = sharedData("probes/probulator/" + file);
    const auto folder = sharedData("reference/probulator/" + name);
    if (!path || !folder) continue;
    const Image probe = loadProbe(*path).latLong;
    const std::pair<Image, std::string> methods[] = {
        {irradianceMap(probe, {256, 128}), "irradianceMCIS.png"},
        {shIrradianceMap(probe, {256, 128}), "irradianceSHL2.png"}};
    for (const auto& [ours, image] : methods) {
      const Image theirs = readImage(*folder / image, IntegerTexels::Linear);
      double bias = 0, difference = 0, sum = 0;
      for (size_t i = 0; i < ours.texels.size(); ++i) {
        const double expected = theirs.texels[i] + 0.5 / 255, e = ours.texels[i] / kPiD;
        if (expected > 0.95 || e > 0.95) continue;  // clipped in the file
        bias += e - expected;
        difference += std::fabs(e - expected);
        sum += expected;
      }
      EXPECT_LT(std::fabs(bias / sum), 0.01) << name << " " << image;
      EXPECT_LT(difference / sum, 0.02) << name << " " << image;
    }
    ++compared;
  }
  if (compared == 0) GTEST_SKIP() << "no reference/probulator";
}

}  // namespace
}  // namespace chromeball::irradiance_test
