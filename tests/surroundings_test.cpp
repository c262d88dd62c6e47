// SPDX-License-Identifier: Apache-2.0
// Surroundings at a finite distance.
#include <gtest/gtest.h>

#include <algorithm>

#include "floor_in_surroundings.h"
#include "hypothesis.h"
#include "probe/synth.h"

namespace chromeball::surroundings_test {
namespace {

Surroundings dome() {
  Surroundings s;
  s.shape = Surroundings::Shape::Sphere;
  s.center = {0.3f, 0.2f, 0}, s.radius = 3;
  s.capture = {0, 1, 0.4f};
  return s;
}

TEST(Surroundings, RaysFromInsideHitTheSurface) {
  for (const Surroundings& s : {box(), dome()})
    for (int i = 0; i < 500; ++i) {
      const vec3 from = s.capture + 0.9f * toUnit(uint32_t(hash(i, 7))) * sphereDirection(i + 1000);
      const vec3 d = sphereDirection(i);
      const Surroundings::Point y = s.behind(from, d);
      EXPECT_LT(glm::length(glm::normalize(y.position - from) - d), 1e-5f);
      EXPECT_LT(glm::dot(y.normal, d), 0);
      EXPECT_TRUE(s.contains(y.position + 1e-3f * y.normal));
      EXPECT_FALSE(s.contains(y.position - 1e-3f * y.normal));
    }
}

// Strategies and the tolerance of the relative error at a position on the floor.
constexpr std::pair<const char*, double> kStrategies[] = {{"bsdf", 0.03},
                                                          {"uniform", 0.03},
                                                          {"importance", 0.03},
                                                          {"suns", 0.03},
                                                          {"kollig-keller-strata:4", 0.03},
                                                          {"irradiance-fit-ambient:8", 0.3}};

std::unique_ptr<LightSource> makeLighting(const Surroundings& s, const char* name,
                                          const Probe& probe) {
  return std::make_unique<FiniteSurroundings>(makeStrategy(name, probe, Mis::Balance, "test"),
                                              probe, s);
}

// Under surroundings of constant radiance, the exitant radiance is the same at every position.
TEST(Surroundings, ConstantRadianceIsIndependentOfPosition) {
  const Probe probe(constantProbe({8, 4}, Rgb(2)));
  for (const Surroundings& s : {box(), dome()})
    for (const char* name : {"bsdf", "uniform", "importance"})
      for (const vec2 at : {vec2(0, 0), vec2(-1, 1)}) {
        const Moments m = floorRadiance(*makeLighting(s, name, probe), at.x, at.y, 6);
        EXPECT_NEAR(m.mean, 1, 0.01) << name;
      }
}

// Irradiance of the floor by quadrature over the upper hemisphere: E = integral of L cos dw.
double floorIrradiance(const Surroundings& s, const Probe& probe, const vec3& x) {
  constexpr int kRows = 300;
  double sum = 0;
  for (int i = 0; i < kRows; ++i)
    for (int j = 0; j < 4 * kRows; ++j) {
      const double cosine = (i + 0.5) / kRows, sine = std::sqrt(1 - cosine * cosine);
      const double phi = 2 * kPiD * (j + 0.5) / (4 * kRows);
      const vec3 d(sine * std::sin(phi), cosine, sine * std::cos(phi));
      const vec3 y = s.behind(x, d).position;
      sum += luminance(probe.radiance(glm::normalize(y - s.capture))) * cosine;
    }
  return sum * 2 * kPiD / kRows / (4 * kRows);
}

// Every strategy matches the quadrature at two positions with different irradiance. Strategies that
// replace the probe by lights put them on the walls, so the error is larger near a light.
TEST(SlowSurroundings, IrradianceDependsOnPosition) {
  const Probe probe(spotted(), 25);
  double near = 0, far = 0;
  for (const Surroundings& s : {box(), dome()})
    for (const auto& [name, tolerance] : kStrategies) {
      const auto lighting = makeLighting(s, name, probe);
      for (const vec2 at : {vec2(0.5f, -0.5f), vec2(-1.5f, 1.5f)}) {
        const double expected = 0.5 / kPiD * floorIrradiance(s, probe, {at.x, 0.001f, at.y});
        (at.x > 0 ? near : far) = expected;
        const Moments m = floorRadiance(*lighting, at.x, at.y, 6);
        if (lighting->unbiased()) {
          EXPECT_GT(tTest(m, expected), sidak(1e-3, 20))
              << name << " " << m.mean << " " << expected;
        }
        EXPECT_NEAR(m.mean / expected, 1, tolerance) << name;
      }
      EXPECT_GT(std::abs(near / far - 1), 0.05);
    }
}

// sample() and escaped() return the same radiance and pdf for a direction.
TEST(Surroundings, PdfsAgree) {
  const Probe probe(spotted(), 25);
  const SobolTable table(64, 16, 0);
  PixelSampler sampler(table, 0);
  for (const Surroundings& s : {box(), dome()})
    for (const char* name : {"uniform", "importance"}) {
      const auto lighting = makeLighting(s, name, probe);
      for (uint32_t i = 0; i < 640; ++i) {
        sampler.startPixel(i / 64, 3, 0);
        sampler.startSample(i % 64);
        sampler.startVertex(0);
        const LightPoint point{{-1, 0.5f, 0.7f}, {0, 1, 0}, nullptr, 0};
        std::vector<DirectionSample> samples;
        lighting->sample(point, sampler, samples);
        for (const DirectionSample& sample : samples) {
          const auto found = lighting->escaped(point, sample.wi);
          // Rounding may move a sample at the edge of the bright texel across it.
          EXPECT_NEAR(found.pdf / sample.pdf, 1, 5e-3) << name;
          const Rgb radiance = sample.irradiance * sample.pdf;
          EXPECT_LT(glm::length(found.radiance - radiance), 5e-3f * (1 + glm::length(radiance)));
        }
      }
    }
}

// The discs with which `suns` replaces a probe's sources light only matte surfaces; the camera and
// mirrors see the original probe.
TEST(Surroundings, SunsAreInvisibleToCameraAndMirrors) {
  Image map = spotted();
  map.setRgb(12, 4, Rgb(6000, 4000, 3000));
  const Probe probe(map, 25);
  ASSERT_FALSE(makeStrategy("suns", probe, Mis::Balance, "test")->unbiased())
      << "the probe has a source";
  Scene scene;
  Material mirror;
  mirror.roughness = 0;
  mirror.doubleSided = true;
  addSphere(scene, addMaterial(scene, mirror), {0.8f, 0.6f, -1}, 0.4f, 24);
  const World world(scene);
  const vec3 eye(0, 1.2f, 0.5f);
  vec3 brightest(0, -1, 0);
  for (uint64_t i = 0; i < 20000; ++i)
    if (const vec3 d = sphereDirection(i);
        luminance(probe.radiance(d)) > luminance(probe.radiance(brightest)))
      brightest = d;
  const std::atomic<bool> stop = false;
  for (const Surroundings& s : {box(), dome()}) {
    const auto renderMean = [&](const char* name) {
      // The camera looks at the source; the mirror ball is beside it.
      const vec3 to = s.behind(s.capture, brightest).position;
      const Camera camera = Camera::lookAt(eye, to, {0, 1, 0}, 1.6f);
      return render(
                 world, camera, *makeLighting(s, name, probe), smallRender(32, 32, 4, 2),
                 [](double) {}, stop)
          .film.mean();
    };
    const Image found = renderMean("suns"), expected = renderMean("importance");
    EXPECT_EQ(found.texels, expected.texels);
    EXPECT_GT(*std::max_element(expected.texels.begin(), expected.texels.end()), 1000);
  }
}

// Surroundings of a large radius converge to the infinitely distant probe.
TEST(Surroundings, ConvergeToTheDistantProbe) {
  Surroundings s = dome();
  s.radius = 1e4f;
  s.capture = s.center;
  const Probe probe(spotted());
  const auto lighting = makeLighting(s, "importance", probe);
  for (int i = 0; i < 200; ++i) {
    const vec3 d = sphereDirection(i);
    EXPECT_LT(glm::length(lighting->background({1, -1, 0.5f}, d) - probe.radiance(d)),
              0.02f + 0.01f * glm::length(probe.radiance(d)));
  }
}

}  // namespace
}  // namespace chromeball::surroundings_test
