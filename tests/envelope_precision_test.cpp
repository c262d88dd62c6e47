// SPDX-License-Identifier: Apache-2.0
// tests/ENVELOPE.md, "Measured errors": the renderer's arithmetic compared with long double. Each
// test prints the errors that the table lists and checks their bounds.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "envelope.h"
#include "math/cdf.h"
#include "probe/mapping.h"
#include "probe/synth.h"
#include "scene/surface.h"

namespace chromeball::envelope_precision_test {
namespace {

constexpr long double kPiL = 3.141592653589793238462643383279502884L;

// Width of a column's interval in u, measured by how sample() maps two values of u inside it.
long double width(const CdfRows& table, int column, long double from, long double to) {
  double a = double(from + 0.25L * (to - from)), b = double(from + 0.75L * (to - from));
  const double ua = a, ub = b;
  EXPECT_EQ(table.sample(0, a), column);
  EXPECT_EQ(table.sample(0, b), column);
  return ((long double)(ub)-ua) / ((long double)(b)-a);
}

TEST(EnvelopePrecision, CdfOfDoubles) {
  const int columns = 16384;
  std::mt19937 random(1);
  for (const auto& [name, sun, bound] :
       {std::tuple("smooth", 1.0, 1e-11), std::tuple("a sun of 1e7", 1e7, 1e-7),
        std::tuple("a sun of 1e12", 1e12, 1e-2)}) {
    std::vector<double> weights(columns);
    for (double& w : weights) w = std::uniform_real_distribution(0.5, 1.5)(random);
    weights[5] = sun;
    CdfRows table(1, columns);
    table.setRow(0, weights);
    const long double total = std::accumulate(weights.begin(), weights.end(), 0.0L);
    long double before = 0, worst = 0;
    for (int i = 0; i < columns; ++i) {
      const long double from = before / total, to = (before + weights[i]) / total;
      worst = std::max(worst, std::fabs(width(table, i, from, to) / (to - from) - 1));
      before += weights[i];
    }
    std::printf("CDF, %s: relative error of a column's probability %.1Le\n", name, worst);
    EXPECT_LT(worst, bound) << name;
  }
}

TEST(SlowEnvelopePrecision, FilmOfAMillionSamples) {
  std::mt19937_64 random(2);
  Film film(1, 1);
  long double sum = 0, squares = 0;
  uint64_t count = 0;
  for (int block = 0; count < 1'000'000; ++block) {
    SampleSums sums;
    for (int i = 0; i < 4096; ++i, ++count) {
      // Nine decades, as in an image that contains the sun.
      const float x = std::pow(10.0f, std::uniform_real_distribution(-6.0f, 3.0f)(random));
      sums.add(Rgb(x));
      sum += x;
      squares += (long double)(x)*x;
    }
    film.add(0, 0, block % Film::kHalves, sums);
  }
  const long double mean = sum / count, variance = squares / count - mean * mean;
  const long double error = std::fabs(film.mean().texels[0] / mean - 1);
  std::printf("film, %.2g samples: relative error of the mean %.1Le\n", double(count), error);
  EXPECT_LT(error, 1.2e-7L);  // one rounding to float, the type of the output
  // The squared error of the mean of independent samples.
  EXPECT_NEAR(film.errors().scatter[0].w * double(count) / double(variance), 1, 1e-5);
}

// With 2^25 samples, late samples still have the same weight as the first.
TEST(SlowEnvelopePrecision, AccumulatorsDoNotStall) {
  Film film(1, 1);
  AovFilm aovs(1, 1, {Aov::Albedo, Aov::Alpha});
  FirstHit hit{.hit = true, .depth = 1, .albedo = Rgb(0.1f)};
  const int half = 1 << 24;
  for (int part = 0; part < 2; ++part)
    for (int i = 0; i < half; i += 4096) {
      SampleSums sums;
      hit.albedo = Rgb(part == 0 ? 0.1f : 0.3f);
      for (int j = 0; j < 4096; ++j) {
        sums.add(Rgb(part == 0 ? 1 : 3));
        aovs.add(0, 0, hit);
      }
      film.add(0, 0, part, sums);
    }
  EXPECT_NEAR(film.mean().texels[0], 2, 1e-6);
  EXPECT_NEAR(aovs.finished(Aov::Albedo).texels[0], 0.2f, 1e-6);
  EXPECT_EQ(aovs.finished(Aov::Alpha).texels[0], 1);
}

// Distance of the points that surfaceAt() computes from the plane of their triangle, relative to
// the ray offset: below 1, no ray starts on the wrong side.
TEST(EnvelopePrecision, RayOffset) {
  using lvec3 = glm::vec<3, long double>;
  std::mt19937 random(3);
  const auto uniform = [&](float low, float high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  for (float scale : {1e-4f, 1e-2f, 1.0f, 1e3f, 1e7f}) {
    long double worst = 0;
    for (int i = 0; i < 20000; ++i) {
      const float size = std::pow(10.0f, uniform(-4, 0));
      vec3 p[3];
      for (vec3& v : p) v = vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)) * size;
      const vec3 center = vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
      Scene scene;
      Mesh mesh;
      for (const vec3& v : p) mesh.positions.push_back(scale * (v + center));
      mesh.triangles = {{0, 1, 2}};
      addMesh(scene, addMaterial(scene, lambert(Rgb(1))), mesh);
      const auto& q = scene.meshes[0].positions;
      const lvec3 a(q[0]), normal = glm::cross(lvec3(q[1]) - a, lvec3(q[2]) - a);
      const long double length = glm::length(normal);
      // Skip slivers: rounding may flip their normal.
      if (length < 1e-3L * glm::length(lvec3(q[1]) - a) * glm::length(lvec3(q[2]) - a)) continue;
      const float u = uniform(0, 1), v = uniform(0, 1 - u);
      const Surface s = surfaceAt(scene, scene.instances[0], 0, {u, v}, {0, 1, 0});
      const long double off = std::fabs(glm::dot(lvec3(s.position) - a, normal)) / length;
      worst = std::max(worst, off / s.rayOffset);
    }
    std::printf("ray offset, scale %g: distance to the plane is %.2Lf of the offset\n", scale,
                worst);
    EXPECT_LT(worst, 0.5L) << scale;
  }
}

TEST(EnvelopePrecision, SolidAnglesNearThePole) {
  for (const int height : {16, 1024, 8192}) {
    const int width = 2 * height;
    long double worst = 0, sum = 0;
    for (int row = 0; row < height; ++row) {
      const long double top = kPiL * row / height, bottom = kPiL * (row + 1) / height;
      const long double exact =
          2 * kPiL / width * 2 * std::sin((top + bottom) / 2) * std::sin((bottom - top) / 2);
      const double found = texelSolidAngle(row, width, height);
      worst = std::max(worst, std::fabs(found / exact - 1));
      sum += (long double)(found)*width;
    }
    std::printf("solid angle, %d rows: relative error %.1Le, of their sum %.1Le\n", height, worst,
                std::fabs(sum / (4 * kPiL) - 1));
    EXPECT_LT(worst, 1e-11L);  // largest at the south pole, because of the rounding of pi
    EXPECT_LT(std::fabs(sum / (4 * kPiL) - 1), 1e-13L);
  }
}

// sin(theta) of the Jacobian near the pole, and the error of texel -> direction -> texel.
TEST(EnvelopePrecision, DirectionsNearThePole) {
  const int rows = 8192;
  const Probe probe(constantProbe({8, rows}, Rgb(1)));
  long double worstSine = 0;
  double worstTexel = 0;
  for (int row : {0, 1, 2, 63, 64})
    for (float t : {0.01f, 0.3f, 0.5f, 0.99f}) {
      Probe::Position p{5, row, 0.4f, t, 0};
      const vec3 d = probe.direction(p);
      const long double v = row == 0 ? 0.5L * t : row + (long double)(t)-0.5L;
      const long double sine = std::sin(kPiL * v / rows);
      worstSine = std::max(worstSine, std::fabs(p.sinTheta / sine - 1));
      const Probe::Position back = probe.locate(d);
      worstTexel = std::max({worstTexel, std::fabs(double(back.row) + back.t - row - t),
                             std::fabs(double(back.column) + back.s - 5.4)});
    }
  std::printf("near the pole: relative error of sin(theta) %.1Le, round trip %.1e texels\n",
              worstSine, worstTexel);
  EXPECT_LT(worstSine, 1e-5L);
  EXPECT_LT(worstTexel, 2e-2);
}

}  // namespace
}  // namespace chromeball::envelope_precision_test
