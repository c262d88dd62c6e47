// SPDX-License-Identifier: Apache-2.0
// Strategies that replace the probe by lights: lobes too narrow for these lights reflect the probe
// itself, and the scene's lamps light such lobes as with other strategies.
#include <gtest/gtest.h>

#include "measure/statistics.h"
#include "probe/synth.h"
#include "test_scene.h"

namespace chromeball::narrow_lobes_test {
namespace {

struct NamedMaterial {
  const char* name;
  Material material;
};

// GGX's alpha is 0.09, far below the limit of 16 lights, 0.25.
std::vector<NamedMaterial> narrowMaterials() {
  constexpr float kRoughness = 0.3f;
  Material metal;
  metal.baseColor = {1, 0.8f, 0.4f, 1};
  metal.roughness = kRoughness;
  Material plastic = metal;
  plastic.metallic = 0;
  Material coated = lambert({0.2f, 0.5f, 0.8f});
  coated.extended.emplace();
  coated.extended->clearcoat = 1;
  coated.extended->clearcoatRoughness = kRoughness;
  Material brushed = metal;
  brushed.extended.emplace();
  brushed.extended->anisotropy = 0.3f;
  Material body = plastic;
  body.extended.emplace();
  body.extended->transmission = 1;
  body.extended->thinWalled = false;
  Material sheet = body;
  sheet.extended->thinWalled = true;
  return {{"metal", metal},     {"plastic", plastic}, {"coated", coated},
          {"brushed", brushed}, {"body", body},       {"sheet", sheet}};
}

constexpr int kRepeats = 8;
constexpr const char* kLights[] = {"median-cut:16", "irradiance-fit-ambient:2"};

// A tile; the tests add a lamp in front of it and one behind.
Scene tile(const Material& material) {
  Scene scene;
  addQuad(scene, addMaterial(scene, material), {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
  Mesh& mesh = scene.meshes.edit(scene.meshes.size() - 1);
  mesh.normals.assign(4, {0, 1, 0});
  mesh.tangents.assign(4, {1, 0, 0, 1});
  return scene;
}

// Mean luminance of each of kRepeats renders under a nearly black probe.
std::vector<double> means(const Scene& scene, const char* strategy, Mis mis, uint64_t firstSeed) {
  const Probe dim(constantProbe({16, 8}, Rgb(1e-5f)));
  const Camera camera = Camera::lookAt({0.5f, 2, 2}, vec3(0), {0, 1, 0}, 0.5f);
  std::vector<double> all;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    RenderSettings settings = smallRender(8, 8, 32, 3, firstSeed + uint64_t(repeat));
    settings.mis = mis;
    all.push_back(
        luminance(meanColor(renderScene(scene, camera, dim, strategy, settings).film.mean())));
  }
  return all;
}

// Every strategy in kLights must have the same expectation as `importance`.
void expectSameLight(const Scene& scene, const char* name) {
  const std::vector<double> expected = means(scene, "importance", Mis::Balance, 1);
  const Moments b = Moments::of(expected);
  EXPECT_GT(b.mean, 1e-3) << name;
  EXPECT_LT(std::sqrt(b.variance / kRepeats), 0.1 * b.mean) << name;
  for (const char* strategy : kLights)
    for (const Mis mis : {Mis::Off, Mis::Balance, Mis::Power}) {
      const Moments a = Moments::of(means(scene, strategy, mis, 100));
      EXPECT_GT(welchTest(a, b), sidak(1e-3, 6 * 6))
          << name << ", " << strategy << ", mis " << int(mis) << ": " << a.mean << " and "
          << b.mean;
    }
}

TEST(SlowNarrowLobes, reflectPunctualLights) {
  for (const auto& [name, material] : narrowMaterials()) {
    Scene scene = tile(material);
    for (const float side : {1.0f, -1.0f}) {
      PunctualLight lamp;  // in the mirror direction of the camera, or behind the tile
      lamp.position = {-0.5f, side * 2, -2};
      lamp.intensity = Rgb(2);
      scene.lights.push_back(lamp);
    }
    expectSameLight(scene, name);
  }
}

TEST(SlowNarrowLobes, reflectAreaLights) {
  for (const auto& [name, material] : narrowMaterials()) {
    Scene scene = tile(material);
    Material glow = lambert(Rgb(0));
    glow.emission = Rgb(5, 4, 3);
    const int lamp = addMaterial(scene, glow);
    addQuad(scene, lamp, {-1, 2, -1.6f}, {1, 0, 0}, {0, 0.4f, -0.6f});
    addQuad(scene, lamp, {-1, -2, -1.6f}, {1, 0, 0}, {0, -0.4f, -0.6f});
    expectSameLight(scene, name);
  }
}

}  // namespace
}  // namespace chromeball::narrow_lobes_test
