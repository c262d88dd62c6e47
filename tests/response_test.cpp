// SPDX-License-Identifier: Apache-2.0
// Response curves: solved from exposures, written and read.
#include "probe/capture/exposure.h"

#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "base/error.h"
#include "bracket.h"
#include "image/tonemap.h"
#include "probe/capture/merge_photographs.h"
#include "run_command.h"

namespace chromeball::response_test {
namespace {

// A power with a slight S shape, as films have it.
double encodeFilm(double exposure) {
  const double x = std::pow(exposure, 1 / 2.2);
  return x * (1 + 0.6 * x * (1 - x)) * (1 - 0.48 * x * (1 - x));
}

// A soft shoulder: the rational function of a display transform, of exposures up to 1.5.
double encodeShoulder(double exposure) {
  const auto curve = [](double x) {
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
  };
  return std::pow(curve(1.5 * exposure) / curve(1.5), 1 / 2.2);
}

// The largest error of a solved curve, in levels, over the levels that carry weight: the level of
// the exposure that it gives to a level. The scale is fixed at level 128.
double largestError(const ResponseCurve& found, const Encoding& encode) {
  double low = 0, high = 1;  // the exposure of level 128, by bisection
  for (int i = 0; i < 60; ++i)
    (encode((low + high) / 2) < 128 / 255. ? low : high) = (low + high) / 2;
  double largest = 0;
  for (int c = 0; c < 3; ++c)
    for (int level = 5; level <= 245; ++level) {
      const double exposure =
          std::exp(found.logExposure(c, level / 255.) - found.logExposure(c, 128 / 255.)) * low;
      largest = std::max(largest, std::abs(255 * encode(exposure) - level));
    }
  return largest;
}

const std::vector<double> kFive = {4, 1, 0.25, 0.0625, 0.015625};

ResponseCurve solved(std::span<const Exposure> exposures) {
  return solveResponse(exposures, PhotographSeries{}.smoothness);
}

TEST(SolveResponse, IsRecoveredWithinALevel) {
  const Image radiance = ramp(512, 256, 0.003, 60);
  for (const auto encode : {encodeSrgb, encodeFilm, encodeShoulder})
    EXPECT_LT(largestError(solved(bracket(radiance, kFive, encode)), encode), 1);
  EXPECT_LT(largestError(solved(bracket(radiance, {4, 1.3, 0.3, 0.11, 0.02}, encodeLinear)),
                         encodeLinear),
            1);
}

TEST(SolveResponse, IsRecoveredFromNoisyPhotographs) {
  const Image radiance = ramp(512, 256, 0.003, 60);
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0, 1.5f / 255);
  constexpr double kBound = 3;  // twice the noise
  for (const auto encode : {encodeSrgb, encodeFilm, encodeShoulder}) {
    auto exposures = bracket(radiance, kFive, encode, 0);
    for (Exposure& exposure : exposures)
      for (float& level : exposure.levels.texels)
        level = std::round(255 * std::clamp(level + noise(random), 0.f, 1.f)) / 255;
    EXPECT_LT(largestError(solved(exposures), encode), kBound);
  }
}

// Each exposure has an aperture, and so a falloff, of its own.
TEST(SolveResponse, TakesFlatFieldsIntoAccount) {
  const Image radiance = ramp(512, 256, 0.003, 60);
  std::vector<Image> flats;
  std::vector<Exposure> exposures;
  for (size_t i = 0; i < kFive.size(); ++i) {
    const double falloff = 0.15 * double(kFive.size() - 1 - i);  // in a corner
    Image flat(radiance.width, radiance.height, 3), seen = radiance;
    for (int y = 0; y < flat.height; ++y)
      for (int x = 0; x < flat.width; ++x) {
        const double r2 = std::pow(2 * (x + 0.5) / flat.width - 1, 2) +
                          std::pow(2 * (y + 0.5) / flat.height - 1, 2);
        flat.setRgb(x, y, Rgb(float(1 - falloff * r2 / 2)));
        seen.setRgb(x, y, radiance.rgb(x, y) * flat.rgb(x, y));
      }
    flats.push_back(std::move(flat));
    exposures.push_back(bracket(seen, {kFive[i]}, encodeFilm).front());
  }
  for (size_t i = 0; i < flats.size(); ++i) exposures[i].flatField = &flats[i];
  EXPECT_LT(largestError(solved(exposures), encodeFilm), 1);
  for (Exposure& exposure : exposures) exposure.flatField = nullptr;
  EXPECT_GT(largestError(solved(exposures), encodeFilm), 3);
}

TEST(SolveResponse, WhatDoesNotDetermineACurveIsRejected) {
  const Image radiance = ramp(64, 32, 0.003, 60);
  EXPECT_THROW(solved(bracket(radiance, {1})), InputError);
  EXPECT_THROW(solved(bracket(ramp(64, 32, 1, 2), {1e-6, 1e6})), InputError);
  auto swapped = bracket(radiance, {4, 1, 0.25});
  std::swap(swapped[0].factor, swapped[2].factor);
  EXPECT_THROW(solved(swapped), InputError);
}

TEST(ResponseCurve, KnownCurves) {
  for (const double level : {0.01, 0.2, 0.5, 1.0}) {
    EXPECT_NEAR(std::exp(ResponseCurve::linear().logExposure(1, level)), level, 1e-12);
    EXPECT_NEAR(std::exp(ResponseCurve::srgb().logExposure(1, level)), srgbToLinear(float(level)),
                1e-7);
  }
  EXPECT_EQ(ResponseCurve::linear().logExposure(0, 0), -INFINITY);
}

std::string rows(const std::function<std::string(int)>& exposures, int count = 256) {
  std::string text;
  for (int level = 0; level < count; ++level)
    text += std::to_string(level) + "," + exposures(level) + "\n";
  return text;
}

TEST(ResponseCurve, FilesRoundTrip) {
  const TemporaryFolder folder;
  const std::string path = folder / "response.csv";
  std::vector<dvec3> table(256);
  for (int i = 0; i < 256; ++i) table[size_t(i)] = dvec3(0.02, 0.021, 0.019) * double(i) - 5.0;
  const ResponseCurve curve(table);
  curve.write(path);
  const ResponseCurve read = ResponseCurve::read(path);
  for (const double level : {0.0, 0.1, 0.7003, 1.0, 2.0})
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(read.logExposure(c, level), curve.logExposure(c, level), 1e-8);
  // Black may be without exposure; comments and other systems' line ends are accepted.
  const auto doubled = [](int i) { return fmt::format("{0},{0},{0}", i); };
  std::ofstream(path) << "# camera\r\nlevel,red,green,blue\r\n" << rows(doubled);
  EXPECT_EQ(ResponseCurve::read(path).logExposure(0, 0), -INFINITY);
  EXPECT_NEAR(ResponseCurve::read(path).logExposure(2, 100 / 255.), std::log(100), 1e-9);
  std::ofstream(path) << "\xef\xbb\xbflevel,red,green,blue\n" << rows(doubled);
  EXPECT_NEAR(ResponseCurve::read(path).logExposure(2, 100 / 255.), std::log(100), 1e-9);
  // Levels of 16 bits between black and the next one have an exposure.
  for (const double level : {1 / 65535., 0.3 / 255, 0.9 / 255})
    EXPECT_NEAR(ResponseCurve::read(path).logExposure(1, level), std::log(255 * level), 1e-9);
}

TEST(ResponseCurve, BadFilesAreRejected) {
  const TemporaryFolder folder;
  const std::string path = folder / "response.csv", head = "level,red,green,blue\n";
  const auto expectReason = [&](const std::string& text, const std::string& reason) {
    std::ofstream(path, std::ios::binary) << text;
    try {
      ResponseCurve::read(path);
      ADD_FAILURE() << "accepted; should fail: " << reason;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  };
  const auto line = [](int i) { return fmt::format("{0},{0},{0}", i + 1); };
  expectReason("", "no response curve");
  expectReason("1,2,3\n", "first line");
  expectReason(head + rows(line, 255), "ends before level 255");
  expectReason(head + rows(line) + "256,1,1,1\n", "more than 256");
  expectReason(head + "1,1,1,1\n", "the line of level 0");
  expectReason(head + "0,1,1\n", "the line of level 0");
  expectReason(head + "0,1,1,1,1\n", "the line of level 0");
  expectReason(head + rows([](int i) { return fmt::format("{0},{0},{0}", 300 - i); }),
               "above those");
  expectReason(head + rows([](int i) { return fmt::format("{0},{0},{0}", i - 2); }), "above 0");
  expectReason(head + "0,nan,nan,nan\n", "level 0");
  expectReason(std::string(2 << 20, '#'), "longer than");
}

}  // namespace
}  // namespace chromeball::response_test
