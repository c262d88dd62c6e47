// SPDX-License-Identifier: Apache-2.0
// Lights with an ambient term: on real probes and in a hall, and the picture of their irradiance.
#include "lighting/export/light_preview.h"

#include <gtest/gtest.h>

#include <numeric>

#include "base/error.h"
#include "constellation_maps.h"
#include "image/tonemap.h"
#include "lighting/fit/irradiance_fit.h"
#include "lighting/fit/light_descent.h"
#include "math/icosphere.h"
#include "probe/irradiance.h"
#include "probe/mapping.h"
#include "probe/synth.h"

namespace chromeball::irradiance_spheres_test {
namespace {

TEST(Icosphere, FaceOfEachNormal) {
  for (int subdivisions = 0; subdivisions <= 4; ++subdivisions) {
    const std::vector<vec3> normals = icosphereNormals(subdivisions);
    for (size_t i = 0; i < normals.size(); ++i)
      ASSERT_EQ(icosphereFace(3.0f * normals[i], subdivisions), int(i));
  }
}

// The normal of the face is among the nearest: the faces of the finest sphere are 1.6 degrees wide.
TEST(Icosphere, FaceOfAnyDirection) {
  const std::vector<vec3> normals = icosphereNormals(5);
  std::vector<int> hits(normals.size());
  for (const vec3& direction : icosphereNormals(6)) {
    const int face = icosphereFace(direction, 5);
    EXPECT_GT(dot(normals[face], direction), std::cos(1.6f * kPi / 180));
    ++hits[face];
  }
  for (const int n : hits) EXPECT_EQ(n, 4);
}

IrradianceSpheres spheresOf(const Image& map, const Constellation& lights,
                            const std::optional<Rgb>& ambient) {
  const std::vector<vec3> normals = icosphereNormals(3);
  return {3, exactIrradiance(map, normals), irradianceOf(lights, ambient.value_or(Rgb(0)), normals),
          ambient};
}

constexpr ImageSize kFrontProbe{170, 170}, kBackLights{490, 490}, kFrontDifference{810, 170};

// Light of irradiance (2, 1, 0.5) from +X beside a black probe: the right edge of the front and the
// left edge of the back are lit.
TEST(IrradianceSpheres, ShowTheSideThatALightIsOn) {
  const Image picture = irradianceSpheres(
      spheresOf(Image(32, 16, 3), {{vec3(1, 0, 0), Rgb(2, 1, 0.5f), 0}}, std::nullopt));
  ASSERT_EQ(picture.width, 980);
  ASSERT_EQ(picture.height, 660);
  EXPECT_EQ(picture.rgb(kFrontProbe.width, kFrontProbe.height), Rgb(0));
  const Rgb front = picture.rgb(490 + 140, 170), back = picture.rgb(490 - 140, 490);
  for (const Rgb& lit : {front, back}) {
    EXPECT_GT(lit.x, 0.85);
    EXPECT_LE(lit.x, 1);
    EXPECT_NEAR(lit.y, lit.x / 2, 1e-3);
    EXPECT_NEAR(lit.z, lit.x / 4, 1e-3);
  }
  EXPECT_EQ(picture.rgb(490 - 140, 170), Rgb(0));
  EXPECT_EQ(picture.rgb(490 + 140, 490), Rgb(0));
  // The difference is positive in the light, and nothing in the dark: grey of code value 0.5.
  const Rgb bright = picture.rgb(810 + 140, 170), grey = picture.rgb(810 - 140, 170);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(linearToSrgb(grey[c]), 0.5, 1e-5);
    EXPECT_NEAR(linearToSrgb(bright[c]), 0.5 + 0.5 * linearToSrgb(front[c]), 1e-3);
  }
}

// One exposure for all: constant light of radiance 3 is white; 40% of it as ambient light is 40%
// as bright, also in the square, and the difference is as far below grey.
TEST(IrradianceSpheres, HaveOneExposure) {
  const IrradianceSpheres spheres = spheresOf(constantProbe({256, 128}, Rgb(3)), {}, Rgb(1.2f));
  EXPECT_EQ(differenceGain(spheres), 1);
  const Image picture = irradianceSpheres(spheres);
  ASSERT_EQ(picture.width, 1080);
  EXPECT_NEAR(picture.rgb(kFrontProbe.width, kFrontProbe.height).y, 1, 1e-3);
  EXPECT_NEAR(picture.rgb(kBackLights.width, kBackLights.height).y, 0.4, 1e-3);
  EXPECT_NEAR(picture.rgb(1020, 330).y, 0.4, 1e-3);
  EXPECT_NEAR(linearToSrgb(picture.rgb(kFrontDifference.width, kFrontDifference.height).y),
              0.5 - 0.5 * linearToSrgb(0.6f), 1e-3);
}

// A difference of 10% of the brightest is shown eight times as large.
TEST(IrradianceSpheres, MagnifySmallDifferences) {
  const IrradianceSpheres spheres = spheresOf(constantProbe({256, 128}, Rgb(3)), {}, Rgb(2.7f));
  EXPECT_EQ(differenceGain(spheres), 8);
  const Image picture = irradianceSpheres(spheres);
  EXPECT_NEAR(linearToSrgb(picture.rgb(kFrontDifference.width, kFrontDifference.height).y),
              0.5 - 0.5 * linearToSrgb(0.8f), 1e-3);
  IrradianceSpheres same = spheres;
  same.lights = same.probe;
  EXPECT_EQ(differenceGain(same), 1);
}

TEST(IrradianceSpheres, OfABlackProbe) {
  const Image picture = irradianceSpheres(spheresOf(Image(8, 4, 3), {}, Rgb(0)));
  EXPECT_EQ(picture.rgb(kFrontProbe.width, kFrontProbe.height), Rgb(0));
  for (const float texel : picture.texels) ASSERT_TRUE(std::isfinite(texel));
}

// Fit errors of an independent implementation, in percent, with 1 and 4 lights.
TEST(SlowAmbientFit, ErrorsOnRealProbes) {
  struct {
    const char* file;
    double one, four;
  } const kExpected[] = {{"debevec/galileo_probe.hdr", 6.6, 1.4},
                         {"debevec/stpeters_cross.hdr", 9.7, 1.5},
                         {"debevec/grace_probe.hdr", 21, 2.8},
                         {"probulator/uffizi_latlong_small.hdr", 12, 1.4},
                         {"polyhaven/pmndrs_lobby.hdr", 10, 2.2},
                         {"polyhaven/qwantani_afternoon_puresky_1k.hdr", 2.3, 0.69}};
  int found = 0;
  for (const auto& [file, one, four] : kExpected) {
    const auto map = smallProbe(file);
    if (!map) continue;
    ++found;
    EXPECT_NEAR(fitIrradiance(*map, {.count = 1, .ambient = true}).meanError / one, 1, 0.07)
        << file;
    const double error = fitIrradiance(*map, {.count = 4, .ambient = true}).meanError;
    EXPECT_NEAR(error / four, 1, 0.07) << file;
    EXPECT_LT(error, 3) << file;
  }
  if (found == 0) GTEST_SKIP() << "no shared probes";
}

// A hall of 12 x 6.6 x 18 m, seen from 1.6 m above the middle of its red floor. Three windows of 3
// x 3 m in the wall at -X; the wall opposite is nearly white, and lit by them (as in Madsen et al.
// 2003, Fig. 4).
struct Hall {
  static constexpr double kX = 6, kFloor = -1.6, kCeiling = 5, kZ = 9;
  static constexpr double kWindows[3] = {-6, 0, 6};  // z of their middles

  // The window that a ray in `direction` from the origin reaches; -1: none.
  static int window(const dvec3& d) {
    if (d.x >= 0) return -1;
    const dvec3 p = d * (-kX / d.x);
    for (int i = 0; i < 3; ++i)
      if (std::fabs(p.z - kWindows[i]) < 1.5 && p.y > 1 && p.y < 4) return i;
    return -1;
  }

  static Rgb radiance(const dvec3& d) {
    if (const int i = window(d); i >= 0) return Rgb(40, 44, 50) * (1 + 0.2f * float(i));
    const double toX = kX / std::fabs(d.x), toZ = kZ / std::fabs(d.z);
    const double toY = (d.y > 0 ? kCeiling : kFloor) / d.y;
    if (toY <= toX && toY <= toZ) return d.y > 0 ? Rgb(0.3f, 0.25f, 0.2f) : Rgb(0.6f, 0.2f, 0.15f);
    if (toX <= toZ && d.x > 0) return Rgb(2.2f, 2, 1.7f);
    return {0.45f, 0.4f, 0.3f};
  }

  static Image probe() {
    Image map(256, 128, 3);
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x)
        map.setRgb(x, y, radiance(texelDirection({map.width, map.height}, x, y)));
    return map;
  }
};

// "The 3 estimated dominant sources correspond exactly to the locations of the 3 windows. The last
// source corresponds to the diffuse reflection from the almost white wall opposite" (section 3.2).
TEST(SlowAmbientFit, FindsTheWindowsOfAHall) {
  const Image map = Hall::probe();
  dvec3 centres[3] = {}, power[3] = {};
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const dvec3 d = texelDirection({map.width, map.height}, x, y);
      const int i = Hall::window(d);
      if (i < 0) continue;
      const double solidAngle = texelSolidAngle(y, map.width, map.height);
      power[i] += dvec3(map.rgb(x, y)) * solidAngle;
      centres[i] += luminance(dvec3(map.rgb(x, y))) * solidAngle * d;
    }
  const IrradianceFit fit = fitIrradiance(map, {.count = 4, .ambient = true});
  ASSERT_EQ(fit.lights.size(), 4u);
  std::vector<bool> taken(4);
  for (int i = 0; i < 3; ++i) {
    int nearest = 0;
    const auto cosine = [&](int j) {
      return dot(dvec3(fit.lights[j].direction), normalize(centres[i]));
    };
    for (int j = 1; j < 4; ++j)
      if (cosine(j) > cosine(nearest)) nearest = j;
    EXPECT_GT(cosine(nearest), std::cos(3 * kPiD / 180)) << "window " << i;
    EXPECT_NEAR(fit.lights[nearest].irradiance.y / power[i].y, 1, 0.3) << "window " << i;
    EXPECT_FALSE(taken[nearest]);
    taken[nearest] = true;
  }
  const size_t last = std::find(taken.begin(), taken.end(), false) - taken.begin();
  EXPECT_GT(fit.lights[last].direction.x, 0.9);    // the opposite wall
  EXPECT_GT(fit.ambient.x, 1.3f * fit.ambient.y);  // reddish, as the floor
  EXPECT_LT(fit.meanError, 2);
}

}  // namespace
}  // namespace chromeball::irradiance_spheres_test
