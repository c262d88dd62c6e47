// SPDX-License-Identifier: Apache-2.0
// tests/ENVELOPE.md: the rows about materials, emission and path depth.
#include <gtest/gtest.h>

#include "envelope.h"
#include "probe/synth.h"

namespace chromeball::envelope_material_test {
namespace {

Material coated(float roughness, float metallic, float ior) {
  Material m = lambert(Rgb(1));
  m.specular = 1;
  m.roughness = roughness;
  m.metallic = metallic;
  m.ior = ior;
  return m;
}

// White furnace test: a ball of albedo 1 under constant radiance 1 neither gains energy nor loses
// more than ENVELOPE.md states.
TEST(SlowEnvelopeMaterial, RoughnessMetalnessAndIor) {
  const Probe probe(constantProbe({8, 4}, Rgb(1)));
  for (float roughness : {0.0f, 1e-4f, 0.02f, 0.1f, 0.5f, 1.0f})
    for (float metallic : {0.0f, 1e-3f, 0.5f, 1.0f})
      for (float ior : {1.0f, 1.0001f, 1.5f, 10.0f}) {
        Scene scene;
        addSphere(scene, addMaterial(scene, coated(roughness, metallic, ior)), vec3(0), 1, 48);
        RenderSettings settings = smallRender(24, 24, 64, 8);
        const RenderResult r = renderScene(scene, topCamera(5, 20), probe, "importance", settings);
        const double mean = validMean(r);
        EXPECT_LT(mean, 1.004) << roughness << ' ' << metallic << ' ' << ior;
        EXPECT_GT(mean, 0.985) << roughness << ' ' << metallic << ' ' << ior;
      }
}

// A plane seen at grazing angles down to 1e-7 rad, for every kind of lobe.
TEST(EnvelopeMaterial, GrazingAnglesTo1e_7) {
  const Probe probe(constantProbe({8, 4}, Rgb(1)));
  for (float angle : {1e-2f, 1e-4f, 1e-7f})
    for (float roughness : {0.0f, 1e-4f, 0.1f, 1.0f})
      for (float metallic : {0.0f, 1.0f}) {
        const Scene scene = plane(coated(roughness, metallic, 1.5f), 1);
        Camera camera = Camera::lookAt({0, angle, 1}, vec3(0), {0, 1, 0}, angle);
        const RenderResult r =
            renderScene(scene, camera, probe, "importance", smallRender(8, 8, 64, 3));
        const double mean = validMean(r);
        EXPECT_LT(mean, 1.01) << angle << ' ' << roughness << ' ' << metallic;
        EXPECT_GT(mean, 0.9) << angle << ' ' << roughness << ' ' << metallic;
      }
}

// Inside a closed sphere of albedo 1 and emission 1, a path of d bounces has radiance d + 1: energy
// is conserved, and every path has exactly the maximum number of bounces.
TEST(SlowEnvelopeMaterial, AlbedoOneAt1000Bounces) {
  Scene scene;
  Material white = lambert(Rgb(1));
  white.emission = Rgb(1);
  addSphere(scene, addMaterial(scene, white), vec3(0), -2, 16, false);
  const Probe dark(constantProbe({4, 2}, Rgb(0)));
  const Camera camera = Camera::lookAt({0, 0, 0.5f}, {0, 0, 0}, {0, 1, 0}, 1);
  const RenderResult r =
      renderScene(scene, camera, dark, "importance", smallRender(8, 8, 16, 1000));
  EXPECT_NEAR(validMean(r) / 1001, 1, 0.01);
  EXPECT_EQ(r.rays.bounce, 1000 * r.rays.camera);
}

// The same with a coated material: the sum of its lobes must have an albedo of 1.
TEST(SlowEnvelopeMaterial, AWhiteCoatingAt200Bounces) {
  Scene scene;
  Material white = coated(0.5f, 0, 1.5f);
  white.emission = Rgb(1);
  addSphere(scene, addMaterial(scene, white), vec3(0), -2, 16, false);
  const Probe dark(constantProbe({4, 2}, Rgb(0)));
  const Camera camera = Camera::lookAt({0, 0, 0.5f}, {0, 0, 0}, {0, 1, 0}, 1);
  const RenderResult r = renderScene(scene, camera, dark, "importance", smallRender(8, 8, 32, 200));
  EXPECT_NEAR(validMean(r) / 201, 1, 0.05);
}

// Two closed rooms, with lamps of radiance 1e10 and 1e-8. Light samples almost never choose the
// weak lamp; BSDF samples hit it, with an MIS weight of almost 1.
TEST(SlowEnvelopeMaterial, Emission1e10Beside1e_8) {
  const auto room = [](Scene& scene, float x, float emission) {
    Material glow = lambert(Rgb(0));
    glow.emission = Rgb(emission);
    const int wall = addMaterial(scene, lambert(Rgb(0.5f))), lamp = addMaterial(scene, glow);
    for (int axis = 0; axis < 3; ++axis)
      for (float side : {-1.0f, 1.0f}) {
        vec3 corner(-1), a(0), b(0);
        corner[axis] = side, a[(axis + 1) % 3] = 2, b[(axis + 2) % 3] = 2;
        addQuad(scene, axis == 1 && side > 0 ? lamp : wall, corner + vec3(x, 0, 0), a, b);
      }
  };
  const Probe dark(constantProbe({4, 2}, Rgb(0)));
  const auto weakRoom = [&](bool withStrong) {
    Scene scene;
    room(scene, 0, 1e-8f);
    if (withStrong) room(scene, 5, 1e10f);
    const Camera camera =
        Camera::lookAt({0.5f, 0.3f, 0.5f}, {-0.5f, -0.5f, -0.5f}, {0, 1, 0}, 0.8f);
    return validMean(renderScene(scene, camera, dark, "importance", smallRender(16, 16, 256, 4)));
  };
  const double alone = weakRoom(false);
  EXPECT_GT(alone, 1e-9);
  EXPECT_NEAR(weakRoom(true) / alone, 1, 0.03);
}

}  // namespace
}  // namespace chromeball::envelope_material_test
