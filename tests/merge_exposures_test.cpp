// SPDX-License-Identifier: Apache-2.0
// Exposures of known radiance, merged.
#include "probe/capture/merge_exposures.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "bracket.h"
#include "image/io/write_image.h"
#include "image/tonemap.h"
#include "probe/capture/align.h"
#include "probe/capture/exposure.h"
#include "probe/capture/merge_photographs.h"
#include "probe/load.h"
#include "run_command.h"

namespace chromeball::merge_exposures_test {
namespace {

const std::vector<double> kFive = {4, 1, 0.25, 0.0625, 0.015625};

// The largest relative error that rounding to 8 bits makes of a level.
double roundingError(double level) {
  const auto linear = [](double l) { return double(srgbToLinear(float(l))); };
  return (linear(level + 0.5 / 255) - linear(level - 0.5 / 255)) / (2 * linear(level));
}

struct Errors {
  double rms = 0, largestOverBound = 0;
  size_t channels = 0;
};

// Errors of the channels with a level between 20 and 235 in some exposure. The weighted mean of
// logarithms errs at most by the weighted mean of the exposures' rounding errors.
Errors errorsOf(const Image& merged, const Image& radiance, std::span<const Exposure> exposures) {
  Errors errors;
  for (size_t i = 0; i < radiance.texels.size(); ++i) {
    bool isWellExposed = false;
    double bound = 0, weights = 0;
    for (const Exposure& exposure : exposures) {
      const float level = exposure.levels.texels[i];
      isWellExposed |= level > 20 / 255.f && level < 235 / 255.f;
      weights += hatWeight(level);
      if (hatWeight(level) > 0) bound += hatWeight(level) * roundingError(level);
    }
    if (!isWellExposed) continue;
    const double error = merged.texels[i] / double(radiance.texels[i]) - 1;
    errors.rms += error * error;
    errors.largestOverBound = std::max(errors.largestOverBound, std::abs(error) * weights / bound);
    ++errors.channels;
  }
  errors.rms = std::sqrt(errors.rms / double(errors.channels));
  return errors;
}

TEST(MergeExposures, RecoverKnownRadiance) {
  const Image noon = loadProbe(std::string(kSourceDir) + "/probes/noon.exr").latLong;
  for (const Image& radiance : {ramp(256, 64, 0.003, 60), noon}) {
    const std::vector<Exposure> exposures = bracket(radiance, kFive);
    const MergedExposures merged = mergeExposures(exposures, ResponseCurve::srgb());
    const Errors errors = errorsOf(merged.radiance, radiance, exposures);
    EXPECT_GT(errors.channels, radiance.texels.size() / 2);
    EXPECT_LT(errors.rms, 0.01);
    EXPECT_LT(errors.largestOverBound, 1.05);  // second order
    RecordProperty("rms", std::to_string(errors.rms));
  }
}

TEST(MergeExposures, FloatsAreRecoveredExactly) {
  const Image radiance = ramp(64, 16, 0.01, 50);
  const std::vector<Exposure> exposures = bracket(radiance, kFive, encodeLinear, 0);
  const Image merged = mergeExposures(exposures, ResponseCurve::linear()).radiance;
  for (size_t i = 0; i < radiance.texels.size(); ++i)
    EXPECT_NEAR(merged.texels[i] / radiance.texels[i], 1, 2e-6);
}

TEST(MergeExposures, SaturatedPixelsKeepTheBoundOfTheShortestExposure) {
  Image radiance(4, 1, 3);
  radiance.setRgb(0, 0, Rgb(1e6f));
  radiance.setRgb(1, 0, Rgb(0.5f, 1e6f, 0.5f));
  radiance.setRgb(2, 0, Rgb(1e-9f));
  radiance.setRgb(3, 0, Rgb(0.3f));
  const MergedExposures merged =
      mergeExposures(bracket(radiance, {1, 0.25}), ResponseCurve::srgb());
  const float bound = srgbToLinear(kSaturated) / 0.25f;
  EXPECT_NEAR(merged.radiance.rgb(0, 0).x, bound, 1e-5);
  EXPECT_NEAR(merged.radiance.rgb(1, 0).y, bound, 1e-5);
  EXPECT_NEAR(merged.radiance.rgb(1, 0).x, 0.5, 0.005);
  EXPECT_EQ(merged.radiance.rgb(2, 0), Rgb(0));
  EXPECT_EQ(merged.clipped.texels, (std::vector<float>{1, 1, 0, 0}));
  EXPECT_EQ(merged.clippedPixels, 2u);
  EXPECT_EQ(merged.underexposedPixels, 1u);
  EXPECT_EQ(merged.uses[0].saturated, 2u);
  EXPECT_EQ(merged.uses[1].weighted, 2u);
}

// A larger photograph is reduced by means of light, not of levels, and what covers a saturated
// pixel is saturated: a small lamp in a checkerboard has the light of the smaller photograph.
TEST(MergeExposures, ReducedPhotographsKeepTheirLight) {
  const TemporaryFolder folder;
  Image scene(64, 64, 3);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const bool isLamp = x % 16 == 5 && y % 16 == 9;
      scene.setRgb(x, y, isLamp ? Rgb(20) : Rgb((x + y) % 2 ? 0.6f : 0.02f));
    }
  const Image small = resampled(scene, 32, 32);
  constexpr float kShort = 1 / 8.f;
  Image dark = small;
  for (float& texel : dark.texels) texel *= kShort;
  writeImage(folder / "long.png", scene);
  writeImage(folder / "short.png", dark);
  PhotographLevels read = readLevels({folder / "long.png", folder / "short.png"}, {}, true);
  ASSERT_EQ(read.levels[0].width, 32);
  std::vector<Exposure> exposures(2);
  for (size_t i = 0; i < 2; ++i) {
    exposures[i].levels = read.levels[i];
    exposures[i].factor = dvec3(i == 0 ? 1 : kShort);
  }
  const Image merged = mergeExposures(exposures, ResponseCurve::srgb()).radiance;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      EXPECT_NEAR(merged.rgb(x, y).y / small.rgb(x, y).y, 1, 0.04) << x << ',' << y;
}

TEST(MergeExposures, WhatIsNoNumberTellsNothing) {
  Image levels(2, 1, 3);
  levels.setRgb(0, 0, Rgb(NAN, INFINITY, -1));
  levels.setRgb(1, 0, Rgb(0.5f));
  const std::vector<Exposure> exposures = {{"a", levels, dvec3(1)}};
  const MergedExposures merged = mergeExposures(exposures, ResponseCurve::linear());
  EXPECT_EQ(merged.radiance.rgb(0, 0), Rgb(0, kSaturated, 0));
  EXPECT_EQ(merged.radiance.rgb(1, 0), Rgb(0.5f));
}

// HDRI book, section 9.3.5: f/4 lets 16.63 times as much light pass as f/16, not 16 times. Where
// one aperture shows what the other cannot, radiance steps by 16.63 / 16.
TEST(MergeExposures, AWrongApertureRatioLeavesAStep) {
  Image radiance(2, 1, 3);
  radiance.setRgb(0, 0, Rgb(0.1f));  // black at f/16
  radiance.setRgb(1, 0, Rgb(9));     // white at f/4
  const std::vector<CameraSettings> settings = {{.time = 1, .aperture = 4},
                                                {.time = 1. / 64, .aperture = 16}};
  const auto stepWith = [&](const std::vector<ApertureRatio>& ratios) {
    const std::vector<double> factors = exposureFactors(settings, ratios);
    const double f4 = 1. / 16;
    std::vector<Exposure> exposures;
    exposures.push_back(
        {"f/4", photographed(radiance, dvec3(f4), encodeLinear, 0), dvec3(factors[0])});
    exposures.push_back({"f/16", photographed(radiance, dvec3(f4 / 16.63 / 64), encodeLinear, 0),
                         dvec3(factors[1])});
    exposures[0].levels.setRgb(1, 0, Rgb(1));
    exposures[1].levels.setRgb(0, 0, Rgb(0));
    const Image merged = mergeExposures(exposures, ResponseCurve::linear()).radiance;
    return merged.rgb(1, 0).x / merged.rgb(0, 0).x / 90;
  };
  EXPECT_NEAR(stepWith({}), 16 / 16.63, 1e-5);  // 3.9%
  EXPECT_NEAR(stepWith({{4, 16, 16.63}}), 1, 1e-5);
}

TEST(MergeExposures, FactorsOfApertures) {
  const std::vector<CameraSettings> settings = {{.time = 2, .aperture = 4, .iso = 200},
                                                {.time = 2, .aperture = 8, .iso = 100},
                                                {.time = 2, .aperture = 16, .iso = 100}};
  const auto factors = exposureFactors(settings, std::vector<ApertureRatio>{{4, 8, 5}, {8, 16, 4}});
  EXPECT_DOUBLE_EQ(factors[0], 2. * 2 / 16);
  EXPECT_DOUBLE_EQ(factors[1], 2. / 16 / 5);
  EXPECT_DOUBLE_EQ(factors[2], 2. / 16 / 20);
  EXPECT_THROW(exposureFactors(settings, std::vector<ApertureRatio>{{4, 11, 5}}), InputError);
  EXPECT_THROW(exposureFactors(settings, std::vector<ApertureRatio>{{8, 16, 4}, {4, 8, 5}}),
               InputError);
  EXPECT_DOUBLE_EQ(exposureFactors(std::vector<CameraSettings>{{.time = 0.5}}, {}).front(), 0.5);
}

// Each exposure is divided by the flat field of its aperture.
TEST(MergeExposures, FlatFieldsAreDividedBeforeTheMerge) {
  const Image radiance = ramp(32, 8, 0.02, 20);
  Image flat(32, 8, 3), shaded = radiance;
  for (size_t i = 0; i < flat.texels.size(); ++i) {
    flat.texels[i] = 1 - 0.5f * float(i) / float(flat.texels.size());
    shaded.texels[i] *= flat.texels[i];
  }
  std::vector<Exposure> exposures = bracket(shaded, {1}, encodeLinear, 0);
  exposures.front().flatField = &flat;
  exposures.push_back({"f/16", photographed(radiance, dvec3(0.02), encodeLinear, 0), dvec3(0.02)});
  const Image merged = mergeExposures(exposures, ResponseCurve::linear()).radiance;
  for (size_t i = 0; i < radiance.texels.size(); ++i)
    EXPECT_NEAR(merged.texels[i] / radiance.texels[i], 1, 2e-6);
  const auto agreements = exposureAgreement(exposures, ResponseCurve::linear());
  ASSERT_EQ(agreements.size(), 1u);
  EXPECT_LT(agreements[0].error().value_or(1), 1e-5);
}

TEST(ExposureAgreement, FindsTheTrueRatio) {
  std::vector<Exposure> exposures = bracket(ramp(128, 64, 0.003, 60), kFive);
  std::swap(exposures[1], exposures[3]);
  exposures[2].factor *= 1.1;  // 0.25 is said to be 0.275
  const auto agreements = exposureAgreement(exposures, ResponseCurve::srgb());
  ASSERT_EQ(agreements.size(), 4u);
  EXPECT_EQ(agreements[0].longer, 0u);
  EXPECT_EQ(agreements[0].shorter, 3u);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(agreements[0].found[c], 1, 0.003);
    EXPECT_NEAR(agreements[1].found[c], 1.1, 0.003);
    EXPECT_NEAR(agreements[2].found[c], 1 / 1.1, 0.003);
  }
  EXPECT_NEAR(agreements[1].error().value_or(0), 0.1, 0.003);
  const auto none = exposureAgreement(bracket(ramp(64, 8, 1, 2), {1, 1e-6}), ResponseCurve::srgb());
  EXPECT_FALSE(none.front().error());
}

// Texture whose radiance is a function of position.
Image texture(int dx, int dy) {
  Image image(320, 280, 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double u = (x - dx) * 0.11, v = (y - dy) * 0.13;
      const double wave =
          std::sin(u) + std::sin(v + 1.7 * std::sin(u * 0.37)) + std::sin(0.3 * (u - v));
      image.setRgb(x, y, Rgb(float(std::exp(1.2 * wave))));
    }
  return image;
}

TEST(FindShift, BetweenDifferentExposures) {
  for (const auto& [dx, dy] : {std::pair{5, -3}, {0, 0}, {-31, 17}, {2, 0}}) {
    const Shift shift = findShift(photographed(texture(0, 0), dvec3(0.5)),
                                  photographed(texture(dx, dy), dvec3(0.05), encodeLinear));
    EXPECT_EQ(shift.dx, dx);
    EXPECT_EQ(shift.dy, dy);
    EXPECT_EQ(shift.isCertain(), dx != 0 || dy != 0);
  }
}

TEST(FindShift, NoneWhereNothingCanBeCompared) {
  const Image white = photographed(texture(0, 0), dvec3(1e9)), flat(64, 64, 3);
  EXPECT_FALSE(findShift(white, photographed(texture(9, 9), dvec3(0.05))).isCertain());
  EXPECT_FALSE(findShift(flat, flat).isCertain());
  EXPECT_FALSE(findShift(Image(1, 1, 3), Image(1, 1, 3)).isCertain());
}

TEST(FilterTransmission, OfTwoImages) {
  Image without = ramp(32, 8, 0.02, 20), with = without;
  const Rgb transmission(0.00105f, 0.00098f, 0.00091f);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 32; ++x) with.setRgb(x, y, without.rgb(x, y) * transmission);
  without.setRgb(3, 3, Rgb(1));  // a clipped sun
  Image clipped(32, 8, 1);
  *clipped.at(3, 3) = 1;
  with.setRgb(4, 4, Rgb(0, 1, 1));
  const FilterTransmission found = filterTransmission(with, nullptr, without, &clipped);
  EXPECT_EQ(found.pixels, 32u * 8 - 2);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(found.transmission[c] / transmission[c], 1, 1e-6);
    EXPECT_NEAR(found.median[c] / transmission[c], 1, 1e-6);
  }
  EXPECT_THROW(filterTransmission(Image(2, 2, 3), nullptr, Image(2, 2, 3), nullptr), InputError);
}

}  // namespace
}  // namespace chromeball::merge_exposures_test
