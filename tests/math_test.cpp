// SPDX-License-Identifier: Apache-2.0
// Warps, trigonometry and tabulated distributions.
#include <gtest/gtest.h>

#include "math/cdf.h"
#include "math/vec.h"
#include "sphere_test.h"

namespace chromeball::math_test {
namespace {

TEST(Trig, agreesWithTheStandardLibrary) {
  for (int i = -100000; i <= 100000; ++i) {
    const float turns = float(i) / 100000;
    float sine, cosine;
    sinCosTurns(turns, sine, cosine);
    ASSERT_NEAR(sine, std::sin(2 * kPiD * turns), 2e-7);
    ASSERT_NEAR(cosine, std::cos(2 * kPiD * turns), 2e-7);
    for (double radius : {1e-20, 1.0, 1e15}) {
      const auto x = float(radius * std::cos(2 * kPiD * turns));
      const auto y = float(radius * std::sin(2 * kPiD * turns));
      ASSERT_NEAR(atan2Turns(y, x), std::atan2(double(y), double(x)) / (2 * kPiD), 6e-8);
    }
  }
  EXPECT_EQ(atan2Turns(0.0f, 0.0f), 0);
  EXPECT_TRUE(std::isnan(atan2Turns(NAN, 1.0f)));
}

TEST(Frame, isOrthonormalForEveryNormal) {
  for (int i = 0; i < 10000; ++i) {
    vec3 n = squareToUniformSphere(random2(i, 0));
    if (i < 6) n = vec3(i == 0, i == 1, i == 2) - vec3(i == 3, i == 4, i == 5);
    const Frame f(n);
    ASSERT_NEAR(glm::length(f.x), 1, 1e-5);
    ASSERT_NEAR(glm::dot(f.x, f.y), 0, 1e-5);
    ASSERT_NEAR(glm::dot(glm::cross(f.x, f.y), n), 1, 1e-5);
    const vec3 v = squareToUniformSphere(random2(i, 2));
    ASSERT_NEAR(glm::distance(f.toWorld(f.toLocal(v)), v), 0, 1e-6);
  }
}

struct Warp {
  const char* name;
  vec3 (*toDirection)(vec2);
  double (*pdf)(const vec3&);
  vec2 (*toSquare)(const vec3&);
};
const Warp kWarps[] = {
    {"uniform sphere", squareToUniformSphere,
     [](const vec3&) { return double(squareToUniformSpherePdf()); }, uniformSphereToSquare},
    {"uniform hemisphere", squareToUniformHemisphere,
     [](const vec3& v) { return double(squareToUniformHemispherePdf(v)); },
     [](const vec3& v) { return vec2(azimuthTurns(v), 1 - v.z); }},
    {"cosine hemisphere", squareToCosineHemisphere,
     [](const vec3& v) { return double(squareToCosineHemispherePdf(v)); },
     [](const vec3& v) { return vec2(azimuthTurns(v), v.x * v.x + v.y * v.y); }}};

TEST(Warp, matchesItsPdfAndItsInverse) {
  for (const Warp& warp : kWarps) {
    SCOPED_TRACE(warp.name);
    const SphereTest test = testDirections(
        [&](int i) { return std::optional(warp.toDirection(random2(i, 0))); }, warp.pdf, 400000);
    EXPECT_NEAR(test.totalProbability, 1, 1e-3);
    EXPECT_GT(test.chiSquare.pValue, sidak(1e-3, 3));
    for (int i = 0; i < 1000; ++i) {
      const vec2 u = random2(i, 5), back = warp.toSquare(warp.toDirection(u));
      ASSERT_NEAR(u.x, back.x, 2e-5);
      ASSERT_NEAR(u.y, back.y, 2e-6);
    }
  }
}

vec2 triangleToSquare(vec2 b) {
  return b.y > b.x ? vec2{2 * b.x, b.y + b.x} : vec2{b.x + b.y, 2 * b.y};
}

TEST(Warp, triangleIsUniformAndInvertible) {
  std::vector<double> counts(16);  // 16 cells of equal area: two levels of midpoint subdivision
  constexpr int kSamples = 100000;
  for (int i = 0; i < kSamples; ++i) {
    const vec2 u = random2(i, 0);
    vec2 b = squareToTriangle(u);
    ASSERT_GE(b.x, 0);
    ASSERT_GE(b.y, 0);
    ASSERT_LE(b.x + b.y, 1 + 1e-6f);
    ASSERT_NEAR(glm::distance(triangleToSquare(b), u), 0, 1e-6);
    int cell = 0;
    for (int level = 0; level < 2; ++level) {
      const float c = 1 - b.x - b.y;
      const int part = b.x > 0.5f ? 1 : b.y > 0.5f ? 2 : c > 0.5f ? 3 : 0;
      cell = 4 * cell + part;
      if (part == 0) b = {1 - 2 * b.x, 1 - 2 * b.y};
      if (part == 1) b = {2 * b.x - 1, 2 * b.y};
      if (part == 2) b = {2 * b.x, 2 * b.y - 1};
      if (part == 3) b = {2 * b.x, 2 * b.y};
    }
    ++counts[cell];
  }
  const std::vector<double> expected(16, kSamples / 16.0);
  EXPECT_GT(chiSquareTest(counts, expected).pValue, 1e-3);
}

TEST(CdfRows, samplesColumnsInProportionAndRemapsU) {
  const std::vector<double> weights{0, 3, 0, 0, 1, 4, 0};
  CdfRows rows(2, 7);
  EXPECT_EQ(rows.setRow(1, weights), 8);
  std::vector<double> counts(7);
  constexpr int kSamples = 80000;
  for (int i = 0; i < kSamples; ++i) {
    double u = (i + 0.5) / kSamples;
    const double before = u;
    const int column = rows.sample(1, u);
    ++counts[column];
    double sum = 0;
    for (int c = 0; c < column; ++c) sum += weights[c];
    ASSERT_NEAR((sum + u * weights[column]) / 8, before, 1e-12);
  }
  for (int c = 0; c < 7; ++c) EXPECT_NEAR(counts[c], weights[c] / 8 * kSamples, 1.01);
}

// Also with columns of less than a fraction's width, and at the ends of all columns.
TEST(CdfRows, fractionsFindTheSameColumns) {
  for (const double most : {1.0, 1e3, 1e12}) {
    std::vector<double> weights(3000);
    for (size_t i = 0; i < weights.size(); ++i)
      weights[i] = i < 10 || i % 7 == 0 ? 0 : 1 + double(hash(i) % 100);
    weights[2000] = most;
    CdfRows exact(1, 3000);
    FractionCdfRows rows(2, 3000);
    EXPECT_EQ(rows.setRow(1, weights), exact.setRow(0, weights));
    const auto expectSame = [&](uint32_t u) {
      double rest = u * 0x1p-32;
      float within;
      ASSERT_EQ(rows.sample(1, u, within), exact.sample(0, rest)) << u;
      ASSERT_GE(within, 0);
      ASSERT_LE(within, 1);
      if (most < 1e12) {
        ASSERT_NEAR(within, rest, 2e-5);
      }
    };
    for (uint64_t i = 0; i < 100'000; ++i) expectSame(uint32_t(hash(i)));
    for (const double end : exact.row(0))
      for (const double step : {-1.0, 0.0, 1.0})
        expectSame(uint32_t(std::clamp(end * 0x1p32 + step, 0.0, 0x1p32 - 1)));
  }
}

TEST(CdfRows, aWeightOf1e12PreservesTheOtherWidths) {
  std::vector<double> weights(16384, 1.0);
  weights[5000] = 1e12;
  CdfRows rows(1, 16384);
  const double total = rows.setRow(0, weights);
  for (int column : {0, 4999, 5001, 9000, 16383}) {
    const double before = column < 5000 ? column : column - 1 + 1e12;
    double u = (before + 0.5) / total;
    EXPECT_EQ(rows.sample(0, u), column);
    EXPECT_NEAR(u, 0.5, 1e-3);
  }
  double u = 0x1.fffffffffffffp-1;
  EXPECT_EQ(rows.sample(0, u), 16383);
}

}  // namespace
}  // namespace chromeball::math_test
