// SPDX-License-Identifier: Apache-2.0
// `kollig-keller-strata`: its pdf, and its unbiased estimates.
#include "lighting/strata.h"

#include <gtest/gtest.h>

#include "lighting/importance.h"
#include "probe/mapping.h"
#include "probe/synth.h"
#include "sphere_test.h"

namespace chromeball::strata_test {
namespace {

struct Case {
  const char* name;
  Image map;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  all.push_back({"constant", constantProbe({16, 8}, Rgb(0.3f))});
  all.push_back({"one texel", oneHotProbe({32, 16}, 11, 5, Rgb(1))});
  all.push_back({"seam", oneHotProbe({32, 16}, 31, 8, Rgb(1))});
  all.push_back({"pole", oneHotProbe({32, 16}, 3, 0, Rgb(1))});
  all.push_back({"1x1", constantProbe({1, 1}, Rgb(2))});
  all.push_back({"gradient", gradientProbe({64, 32}, Rgb(1, 2, 3), {0.5, 0.5, 0.5})});
  Image sun = constantProbe({32, 16}, Rgb(0.5f));
  sun.setRgb(20, 4, Rgb(2000));
  all.push_back({"sun over a grey sky", sun});
  return all;
}

LightPoint at(int depth) {
  LightPoint point{};
  point.normal = {0, 1, 0};
  point.depth = depth;
  return point;
}

float pdf(const Strata& strata, const vec3& wi, int depth) {
  return strata.escaped(at(depth), wi).pdf;
}

TEST(Strata, samplesFollowThePdfInEveryRegion) {
  const std::vector<Case> all = cases();
  for (const Case& c : all) {
    SCOPED_TRACE(c.name);
    const Probe probe(c.map, 33);
    const Strata strata(probe, 5);
    const int regions = strata.regions();
    const SphereTest test = testDirections(
        [&](int i) {
          return std::optional(strata.sampleRegion(i % regions, random1(i, 0), random1(i, 1)).wi);
        },
        [&](const vec3& w) { return pdf(strata, w, 0) / float(regions); }, 100000, 3, 12, 24);
    EXPECT_NEAR(test.totalProbability, 1, 5e-3);
    EXPECT_GT(test.chiSquare.pValue, sidak(1e-3, int(all.size())));
  }
}

TEST(Strata, samplesAreInTheirRegionAndHaveThePdfOfTheirDirection) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const Probe probe(c.map);
    const Strata strata(probe, 5);
    int strays = 0;
    for (int i = 0; i < 20000; ++i) {
      const int region = i % strata.regions();
      const DirectionSample s = strata.sampleRegion(region, random1(i, 0), random1(i, 1));
      ASSERT_GT(s.pdf, 0);
      if (strata.regionOf(s.wi) != region) {  // rounded into a neighbouring cell
        ++strays;
        continue;
      }
      ASSERT_NEAR(pdf(strata, s.wi, 0), s.pdf, 2e-3f * s.pdf + 1e-3f);
      const vec3 w = squareToUniformSphere(random2(i, 2));
      if (luminance(probe.radiance(w)) > 0) {
        ASSERT_GT(pdf(strata, w, 0), 0);
      }
    }
    EXPECT_LT(strays, 20);
  }
}

// The pdf is proportional to the radiance, so radiance / pdf is the energy of the sample's region;
// the sum over all regions is the energy of the probe.
TEST(Strata, samplesOfAGreyProbeHaveConstantWeight) {
  Image map = constantProbe({256, 128}, Rgb(1));
  for (int i = 0; i < 256 * 128; ++i)
    map.setRgb(i % 256, i / 256, Rgb(random1(i, 0) < 0.1f ? 100 : 1));
  const Probe probe(map);
  const Strata strata(probe, 8);
  EXPECT_EQ(strata.regions(), 8);
  double all = 0;
  for (int region = 0; region < strata.regions(); ++region) {
    std::vector<double> irradiances;
    for (int i = 0; i < 4000; ++i)
      irradiances.push_back(strata.sampleRegion(region, random1(i, 1), random1(i, 2)).irradiance.y);
    const Moments m = Moments::of(irradiances);
    EXPECT_LT(std::sqrt(m.variance), 0.05 * m.mean);
    all += m.mean;
  }
  EXPECT_NEAR(all, 4 * kPiD * meanRadiance(map).y, 0.005 * all);
}

TEST(Strata, laterHitsChooseRegionsInProportionToLuminance) {
  for (const Case& c : cases()) {
    const Probe probe(c.map, 12);
    const Strata strata(probe, 7);
    const Importance importance(probe, false);
    for (int i = 0; i < 1000; ++i) {
      const vec3 w = squareToUniformSphere(random2(i, 0));
      const float expected = Strata::kLater * importance.pdf(w);
      EXPECT_NEAR(pdf(strata, w, 1), expected, 1e-4f * expected + 1e-6f) << c.name;
    }
  }
}

// The estimate of an integral over the sphere is unbiased at every depth.
TEST(Strata, estimatesAreUnbiased) {
  Image map = gradientProbe({32, 16}, Rgb(1, 2, 3), {0.5, 0.4, 0.2});
  map.setRgb(9, 5, Rgb(80, 60, 40));
  const Probe probe(map, 50);
  const Strata strata(probe, 12);
  const auto f = [](const vec3& w) { return w.x > 0.1f ? w.y * w.y : 0.2f; };
  const Importance importance(probe, false);
  double expected = 0;
  constexpr int kExact = 1000;
  for (int i = 0; i < kExact; ++i)
    for (int j = 0; j < kExact; ++j) {
      const DirectionSample s = importance.sampleDirection((i + 0.5) / kExact, (j + 0.5) / kExact);
      expected += double(luminance(s.irradiance)) * f(s.wi) / (double(kExact) * kExact);
    }
  for (int depth : {0, 1}) {
    std::vector<double> means;
    for (uint64_t seed = 0; seed < 24; ++seed) {
      constexpr uint32_t kSamples = 256;
      const SobolTable table(kSamples, dimension::kVertex + 2 * dimension::kPerVertex, seed);
      PixelSampler sampler(table, seed);
      sampler.startPixel(1, 2, 0);
      double sum = 0;
      for (uint32_t i = 0; i < kSamples; ++i) {
        sampler.startSample(i);
        sampler.startVertex(depth);
        std::vector<DirectionSample> samples;
        strata.sample(at(depth), sampler, samples);
        for (const DirectionSample& s : samples) sum += luminance(s.irradiance) * f(s.wi);
      }
      means.push_back(sum / kSamples);
    }
    const Moments m = Moments::of(means);
    EXPECT_GT(tTest(m, expected), sidak(1e-3, 2)) << depth << ": " << m.mean << " " << expected;
    EXPECT_NEAR(m.mean, expected, 0.02 * expected);
  }
}

TEST(Strata, blackProbesHaveNoRegions) {
  const Probe probe(constantProbe({8, 4}, Rgb(0)));
  const Strata strata(probe, 4);
  EXPECT_EQ(strata.regions(), 0);
  EXPECT_EQ(pdf(strata, vec3(0, 1, 0), 0), 0);
  EXPECT_EQ(pdf(strata, vec3(0, 1, 0), 1), 0);
}

}  // namespace
}  // namespace chromeball::strata_test
