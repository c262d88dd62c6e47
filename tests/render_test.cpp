// SPDX-License-Identifier: Apache-2.0
// Renders with known exact results, and independence of the number of threads.
#include "render/render.h"
#include "hypothesis.h"

#include <gtest/gtest.h>

#include "all_tables.h"
#include "base/parallel.h"
#include "lighting/strategy.h"
#include "probe/mapping.h"
#include "probe/synth.h"
#include "test_scene.h"
#include "transport/world.h"

namespace chromeball::render_test {
namespace {

Scene plane(const Material& material) {
  Scene scene;
  addQuad(scene, addMaterial(scene, material), {-10, 0, 10}, {20, 0, 0}, {0, 0, -20});
  return scene;
}

// Irradiance of the plane y = 0 by quadrature over the upper hemisphere.
double irradiance(const Probe& probe, int rows) {
  double sum = 0;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < 4 * rows; ++j) {
      const double theta = kPiD / 2 * (i + 0.5) / rows, phi = 2 * kPiD * (j + 0.5) / (4 * rows);
      const vec3 d(std::sin(theta) * std::sin(phi), std::cos(theta),
                   std::sin(theta) * std::cos(phi));
      sum += luminance(probe.radiance(d)) * std::cos(theta) * std::sin(theta);
    }
  return sum * (kPiD / 2 / rows) * (2 * kPiD / (4 * rows));
}

// Mean luminance of a render; moments over independent seeds.
Moments renderMeans(const Scene& scene, const Camera& camera, const Probe& probe,
                    const std::string& strategy, RenderSettings settings, int repeats) {
  std::vector<double> means;
  for (int i = 0; i < repeats; ++i) {
    settings.seed = 100 + uint64_t(i);
    means.push_back(
        luminance(meanColor(renderScene(scene, camera, probe, strategy, settings).film.mean())));
  }
  return Moments::of(means);
}

constexpr const char* kUnbiased[] = {"bsdf", "uniform", "importance"};

TEST(Render, lambertUnderConstantAndGradientProbes) {
  const Scene scene = plane(lambert(Rgb(0.5f)));
  struct Case {
    Image probe;
    double expected;
  };
  const Case cases[] = {
      {constantProbe({16, 8}, Rgb(2)), 1.0},
      {gradientProbe({512, 256}, Rgb(1), {0.2, 0.6, 0.3}), 0.5 * (1 + 2.0 / 3 * 0.6)}};
  for (const Case& c : cases)
    for (const char* strategy : kUnbiased) {
      const Moments m = renderMeans(scene, topCamera(3, 40), Probe(c.probe), strategy,
                                    smallRender(16, 16, 64, 1), 8);
      EXPECT_NEAR(m.mean, c.expected, 1e-3 * c.expected) << strategy;
    }
}

TEST(SlowRender, lambertUnderOneTexel) {
  Image image = constantProbe({64, 32}, Rgb(0));
  image.setRgb(20, 9, Rgb(100));
  image.setRgb(50, 0, Rgb(30));  // at the pole
  const Probe probe(image);
  const double expected = 0.5 * irradiance(probe, 2000) / kPiD;
  const Scene scene = plane(lambert(Rgb(0.5f)));
  for (const char* strategy : kUnbiased) {
    const Moments m =
        renderMeans(scene, topCamera(3, 40), probe, strategy, smallRender(16, 16, 256, 1), 12);
    EXPECT_GT(tTest(m, expected), sidak(1e-3, 3)) << strategy << ": " << m.mean;
    if (std::string(strategy) == "importance") {
      EXPECT_NEAR(m.mean, expected, 2e-3 * expected);
    }
  }
}

// A white surface facing a sun of 0.5323 degrees and radiance 46,700 has radiance 1 to 1%: exactly
// 46,700 sin^2(0.5323 / 2 degrees).
TEST(Render, theSunOf46700) {
  const double sine = std::sin(0.5323 / 2 * kPiD / 180), expected = 46700 * sine * sine;
  EXPECT_NEAR(expected, 1, 0.01);
  for (glm::dvec3 sun : {glm::dvec3(-0.3, 0.9, -0.01), glm::dvec3(0.1, 0.2, 0.9)}) {
    sun = glm::normalize(sun);
    Image image = constantProbe({2048, 1024}, Rgb(0));
    addSunDisc(image, sun, 0.5323, glm::dvec3(kPiD * expected));
    Scene scene;
    const vec3 across = glm::normalize(glm::cross(vec3(sun), vec3(0, 0, 1)));
    const vec3 along = glm::cross(vec3(sun), across);
    addQuad(scene, addMaterial(scene, lambert(Rgb(1))), -across - along, 2.0f * across,
            2.0f * along);
    const Camera camera = Camera::lookAt(3.0f * vec3(sun), vec3(0), along, 0.4f);
    const Moments m =
        renderMeans(scene, camera, Probe(image), "importance", smallRender(8, 8, 64, 1), 4);
    EXPECT_NEAR(m.mean, expected, 2e-3);
  }
}

// Inside a closed sphere of emission 1 and albedo 1/2, the radiance at maximum depth d is
// 1 + 1/2 + ... + 1/2^d.
TEST(SlowRender, closedEmittingSphereCountsEveryBounce) {
  Scene scene;
  Material material = lambert(Rgb(0.5f));
  material.emission = Rgb(1);
  addSphere(scene, addMaterial(scene, material), vec3(0), -2, 24, false);
  const Probe dark(constantProbe({4, 2}, Rgb(0)));
  const Camera camera = Camera::lookAt({0, 0, 0.5f}, {0, 0, 0}, {0, 1, 0}, 1);
  for (int depth : {0, 1, 2, 5, 12}) {
    const double expected = 2 - std::pow(0.5, depth);
    for (Mis mis : {Mis::Off, Mis::Balance, Mis::Power}) {
      RenderSettings settings = smallRender(16, 16, 64, depth);
      settings.mis = mis;
      const Moments m = renderMeans(scene, camera, dark, "importance", settings, 8);
      EXPECT_GT(tTest(m, expected), sidak(1e-3, 15)) << depth << ": " << m.mean;
      EXPECT_NEAR(m.mean, expected, (mis == Mis::Off ? 0.02 : 0.005) * expected) << depth;
    }
  }
}

// A white object under constant radiance 1 has radiance 1.
TEST(SlowRender, whiteFurnace) {
  for (float metallic : {-1.0f, 0.0f, 0.5f, 1.0f})  // -1: Lambert
    for (float roughness : {0.05f, 0.5f, 1.0f}) {
      if (metallic < 0 && roughness < 1) continue;
      Material material = lambert(Rgb(1));
      if (metallic >= 0) {
        material.metallic = metallic;
        material.specular = 1;
        material.roughness = roughness;
      }
      Scene scene;
      addSphere(scene, addMaterial(scene, material), vec3(0), 1, 96);
      RenderSettings settings = smallRender(24, 24, 64, 16);
      for (const char* strategy : {"bsdf", "importance"}) {
        const Moments m = renderMeans(scene, topCamera(2.2f, 40),
                                      Probe(constantProbe({8, 4}, Rgb(1))), strategy, settings, 4);
        EXPECT_NEAR(m.mean, 1, metallic < 0 ? 1e-3 : 5e-3)
            << strategy << " metallic " << metallic << " roughness " << roughness;
        EXPECT_LT(m.mean, 1 + 1e-3);
      }
    }
}

TEST(Render, sameBitsForAnyNumberOfThreads) {
  Scene scene = plane(lambert(Rgb(0.7f)));
  Material metal;
  metal.roughness = 0.3f;
  addSphere(scene, addMaterial(scene, metal), {0, 0.6f, 0}, 0.6f);
  const Probe probe(gradientProbe({64, 32}, Rgb(1), {0.2, 0.6, 0.3}));
  RenderSettings settings = smallRender(70, 50, 6, 5);
  settings.aovs = {Aov::Albedo, Aov::Depth, Aov::Node};
  std::vector<std::vector<float>> images;
  for (int threads : {1, 2, 3}) {
    const ThreadLimit limit{size_t(threads)};
    const RenderResult r = renderScene(scene, topCamera(4, 50), probe, "importance", settings);
    std::vector<float> all = r.film.mean().texels;
    for (float x : varianceImage(r.film.errors()).texels) all.push_back(x);
    for (float x : r.aovs.finished(Aov::Albedo).texels) all.push_back(x);
    all.push_back(float(r.rays.shadow));
    images.push_back(all);
  }
  EXPECT_EQ(images[0], images[1]);
  EXPECT_EQ(images[0], images[2]);
}

TEST(Render, pixelsHaveExactlyTheRequestedSamples) {
  const Scene scene = plane(lambert(Rgb(0.7f)));
  const Probe probe(constantProbe({8, 4}, Rgb(1)));
  for (const uint32_t samples : {1u, 2u, 3u, 7u, 64u, 100u, 255u, 8192u, 8195u, 20000u}) {
    const RenderResult r =
        renderScene(scene, topCamera(4, 50), probe, "uniform", smallRender(2, 1, samples, 1));
    EXPECT_EQ(r.samples, samples);
    EXPECT_EQ(r.film.sampleCounts().texels, std::vector<float>(2, float(samples)));
    EXPECT_EQ(r.rays.camera, 2 * samples);
  }
}

TEST(Render, stopsAtTheNoiseLimit) {
  const Scene scene = plane(lambert(Rgb(0.7f)));
  const Probe probe(gradientProbe({64, 32}, Rgb(1), {0.2, 0.6, 0.3}));
  RenderSettings settings = smallRender(32, 32, 1 << 20, 3);
  settings.noiseLimit = 0.002;
  const RenderResult r = renderScene(scene, topCamera(4, 50), probe, "uniform", settings);
  EXPECT_LE(r.film.noise().upper, 0.002);
  EXPECT_LT(r.samples, 1u << 16);
  EXPECT_GE(r.samples, 16u);
}

// An estimate of the work left under a limit is too large if the render ends earlier.
TEST(Render, ProgressEndsAtOne) {
  const Scene scene = plane(lambert(Rgb(0.7f)));
  const Probe probe(gradientProbe({64, 32}, Rgb(1), {0.2, 0.6, 0.3}));
  const World world(scene, {}, allTables());
  const auto lighting = makeStrategy("uniform", probe, Mis::Balance, "test");
  const std::atomic<bool> stop = false;
  for (const double limit : {0.05, 0.03, 0.02, 0.013, 0.01}) {
    RenderSettings settings = smallRender(16, 16, 1 << 20, 3);
    settings.noiseLimit = limit;
    double last = 0;
    render(
        world, topCamera(4, 50), *lighting, settings, [&](double fraction) { last = fraction; },
        stop);
    EXPECT_EQ(last, 1) << limit;
  }
}

// A blended plane transmits 1 - alpha; below the cutoff, a mask transmits all light.
TEST(Render, blendedSurfacesTransmitOneMinusAlpha) {
  const Probe probe(constantProbe({8, 4}, Rgb(1)));
  Scene scene;
  Material black = lambert(Rgb(0));
  black.alphaMode = AlphaMode::Blend;
  black.baseColor.w = 0.25f;
  addQuad(scene, addMaterial(scene, black), {-500, 1, 500}, {1000, 0, 0}, {0, 0, -1000});
  addQuad(scene, addMaterial(scene, lambert(Rgb(1))), {-500, 0, 500}, {1000, 0, 0}, {0, 0, -1000});
  for (const char* strategy : kUnbiased) {
    const Moments m =
        renderMeans(scene, topCamera(3, 40), probe, strategy, smallRender(16, 16, 64, 1), 8);
    EXPECT_GT(tTest(m, 0.75 * 0.75), sidak(1e-3, 4)) << strategy << ": " << m.mean;
  }
  scene.materials[0].alphaMode = AlphaMode::Mask;  // 0.25 is below the cutoff
  const Moments m =
      renderMeans(scene, topCamera(3, 40), probe, "importance", smallRender(16, 16, 16, 1), 4);
  EXPECT_NEAR(m.mean, 1, 2e-3);
}

}  // namespace
}  // namespace chromeball::render_test
