// SPDX-License-Identifier: Apache-2.0
#include "base/json.h"
#include "json_file.h"
#include "probe/irradiance.h"

#include <gtest/gtest.h>

#include <fstream>

#include "probe/load.h"
#include "probe/mapping.h"
#include "probe/synth.h"
#include "shared_data.h"

namespace chromeball::spherical_harmonics_test {
namespace {

TEST(SphericalHarmonics, BasisIsOrthonormal) {
  const int w = 256, h = 128;
  std::array<std::array<double, kShCount>, kShCount> products{};
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const auto basis = shBasis(*uvToDirection(Mapping::LatLong, {(x + 0.5) / w, (y + 0.5) / h}));
      for (int i = 0; i < kShCount; ++i)
        for (int j = 0; j < kShCount; ++j)
          products[i][j] += basis[i] * basis[j] * texelSolidAngle(y, w, h);
    }
  for (int i = 0; i < kShCount; ++i)
    for (int j = 0; j < kShCount; ++j) EXPECT_NEAR(products[i][j], i == j, 5e-4) << i << " " << j;
}

// The basis is integrated over texels of any shape.
TEST(SphericalHarmonics, AConstantHasOnlyBand0OnCoarseMaps) {
  for (const ImageSize size :
       {ImageSize{1, 1}, {2, 1}, {3, 5}, {8, 4}, {1, 64}, {512, 2}, {64, 1}}) {
    const ShCoefficients sh = projectSh(constantProbe(size, Rgb(1)));
    for (int i = 0; i < kShCount; ++i)
      EXPECT_NEAR(sh[i].x, i == 0 ? std::sqrt(4 * kPiD) : 0, 1e-3)
          << size.width << " x " << size.height << ", " << i;
  }
}

TEST(SphericalHarmonics, GradientHasOnlyItsOwnTerms) {
  const dvec3 slope(0.3, 0.5, -0.2);
  const ShCoefficients sh = projectSh(gradientProbe({256, 128}, Rgb(1, 2, 3), slope));
  const double band0 = std::sqrt(4 * kPiD), band1 = std::sqrt(4 * kPiD / 3);
  const std::array<double, kShCount> expected{
      band0, band1 * slope.y, band1 * slope.z, band1 * slope.x, 0, 0, 0, 0, 0};
  for (int i = 0; i < kShCount; ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sh[i][c], (c + 1) * expected[i], 2e-3) << i;
}

// Published tables (Ramamoorthi and Hanrahan 2001; Rost's "OpenGL Shading Language"), each up to a
// scale factor. Their z axis points into the image, ours out of it.
TEST(SlowSphericalHarmonics, PublishedCoefficientsOfDebevecsProbes) {
  const auto table = sharedData("reference/sh_coefficients_debevec.json");
  if (!table) GTEST_SKIP() << "no reference/sh_coefficients_debevec.json";
  const auto json = jsonOfFile(*table);
  constexpr std::array kNames = {"L00", "L1m1", "L10", "L11", "L2m2", "L2m1", "L20", "L21", "L22"};
  constexpr std::array kSigns = {1, 1, -1, 1, 1, -1, 1, -1, 1};

  int compared = 0;
  for (const auto& [name, probe] : json.at("probes").items())
    for (const auto& file : probe.at("files")) {
      const std::string fileName = file.at("file");
      const auto path = sharedData("probes/debevec/" + fileName);
      if (!path) continue;
      const ShCoefficients sh = projectSh(loadProbe(*path).latLong);
      double dot = 0, square = 0, largest = 0;
      std::vector<std::pair<double, double>> pairs;  // ours, published
      for (int i = 0; i < kShCount; ++i)
        for (int c = 0; c < 3; ++c) {
          const double published = probe.at("coefficients").at(kNames[i])[c];
          pairs.emplace_back(kSigns[i] * sh[i][c], published);
          dot += pairs.back().first * published;
          square += pairs.back().first * pairs.back().first;
          largest = std::max(largest, std::fabs(published));
        }
      double residual = 0;
      for (const auto& [ours, published] : pairs)
        residual = std::max(residual, std::fabs(dot / square * ours - published) / largest);
      // The residual of a projection with directions at texel corners, as used for the tables, and
      // 0.3% for texel centres: half a texel of 2 pi / 1000.
      EXPECT_LT(residual, double(file.at("max_residual_rel")) + 0.003) << fileName;
      ++compared;
    }
  EXPECT_GE(compared, 3);
}

}  // namespace
}  // namespace chromeball::spherical_harmonics_test
