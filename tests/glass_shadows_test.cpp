// SPDX-License-Identifier: Apache-2.0
// Light that passes bodies of glass without refraction: closed forms of its transmittance.
#include <gtest/gtest.h>

#include "probe/synth.h"
#include "scene/extended_surface.h"
#include "test_scene.h"

namespace chromeball::glass_shadows_test {
namespace {

constexpr float kAlbedo = 0.5f;
const Rgb kAttenuation(0.3f, 1, 3);

Material glass() {
  Material m;
  m.metallic = 0;
  m.roughness = 0;
  m.doubleSided = true;
  m.extended.emplace();
  m.extended->transmission = 1;
  m.extended->thinWalled = false;
  m.extended->attenuation = kAttenuation;
  return m;
}

// A floor at y = 0 and a large slab of glass from y = `bottom` to y = `top`. No edge of a triangle
// is near the axis.
Scene floorAndSlab(float bottom, float top, const Material& material = glass()) {
  Scene scene;
  const int slab = addMaterial(scene, material);
  addQuad(scene, addMaterial(scene, lambert(Rgb(kAlbedo))), {-9, 0, 9}, {18, 0, 0}, {0, 0, -18});
  addQuad(scene, slab, {-99, top, 50}, {198, 0, 0}, {0, 0, -198});
  addQuad(scene, slab, {-99, bottom, -50}, {198, 0, 0}, {0, 0, 198});
  passShadowsStraight(scene.materials);
  return scene;
}

PunctualLight sun(vec3 direction, Rgb irradiance) {
  PunctualLight light;
  light.kind = PunctualLight::Kind::Directional;
  light.direction = glm::normalize(direction);
  light.intensity = irradiance;
  return light;
}

Rgb radianceOf(const Scene& scene, const Camera& camera, uint32_t samples = 1) {
  const Probe black(constantProbe({4, 2}, Rgb(0)));
  return meanColor(
      renderScene(scene, camera, black, "importance", smallRender(8, 8, samples, 1)).film.mean());
}

// A view from between the floor and a slab above y = 0.5, at the floor.
Camera underTheSlab() { return Camera::lookAt({0.5f, 0.4f, 0}, {0, 0, 0}, {0, 1, 0}, 0.001f); }

double schlick(double cosine) { return 0.04 + 0.96 * std::pow(1 - cosine, 5); }

// A source hidden from the camera and mirrors still lights a floor behind glass.
TEST(GlassShadows, InvisibleSunsAndAmbientLampsShineThroughGlass) {
  std::array<Image, 2> images;
  for (const bool isVisible : {false, true}) {
    Scene scene = floorAndSlab(0.5f, 1.25f);
    for (Material& m : scene.materials) m.straightShadows = false;
    scene.suns = {
        {Sun{.direction = {0, 1, 0.2}, .irradiance = Rgb(1), .angle = 30}, isVisible, "sun"}};
    scene.ambient = {{Rgb(0.5f), isVisible, "sky"}};
    images[isVisible] = renderScene(scene, underTheSlab(), Probe(constantProbe({4, 2}, Rgb(0))),
                                    "importance", smallRender(4, 4, 256, 4))
                            .film.mean();
  }
  EXPECT_EQ(images[0].texels, images[1].texels);
  EXPECT_GT(meanColor(images[0]).x, 0.2f * kAlbedo);
}

TEST(GlassShadows, ASlabTransmitsByFresnelAndBeersLaw) {
  for (const double angle : {0.0, 0.9}) {
    Scene scene = floorAndSlab(0.5f, 1.25f);
    const double c = std::cos(angle);
    scene.lights.push_back(sun({std::sin(angle), -c, 0}, Rgb(2)));
    const Rgb found = radianceOf(scene, underTheSlab());
    for (int i = 0; i < 3; ++i) {
      const double passed = std::pow(1 - schlick(c), 2) * std::exp(-kAttenuation[i] * 0.75 / c);
      EXPECT_NEAR(found[i] / (kAlbedo / kPiD * 2 * c * passed), 1, 2e-3) << angle << " " << i;
    }
  }
}

TEST(GlassShadows, ALampInTheGlassIsAbsorbedUpToTheBoundary) {
  Scene scene = floorAndSlab(0.5f, 1.25f);
  PunctualLight lamp;
  lamp.position = {0, 1, 0};
  lamp.intensity = Rgb(2);
  scene.lights.push_back(lamp);
  const Rgb found = radianceOf(scene, underTheSlab());
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(found[i] / (kAlbedo / kPiD * 2 * 0.96 * std::exp(-kAttenuation[i] * 0.5)), 1, 2e-3);
}

// The camera and the light see a floor inside the glass through the same boundary.
TEST(GlassShadows, AFloorInTheGlassIsAbsorbedUpToTheBoundary) {
  for (const bool isNear : {false, true}) {
    Scene scene = floorAndSlab(-1, 0.5f);
    PunctualLight light = sun({0, -1, 0}, Rgb(2));
    if (isNear) {
      light.kind = PunctualLight::Kind::Point;
      light.position = {0, 4, 0};
      light.intensity = Rgb(32);
    }
    scene.lights.push_back(light);
    const Rgb found = radianceOf(scene, topCamera(2, 0.1f), 4096);
    for (int i = 0; i < 3; ++i) {
      const double passed = 0.96 * std::exp(-kAttenuation[i] * 0.5);
      EXPECT_NEAR(found[i] / (kAlbedo / kPiD * 2 * passed * passed), 1, 0.02) << i;
    }
  }
}

// A ray that enters an open mesh, or leaves one that it has not entered, gains nothing.
TEST(GlassShadows, OpenMeshesDoNotAmplify) {
  for (const bool up : {false, true}) {
    Scene scene;
    Material dense = glass();
    dense.extended->attenuation = Rgb(1e10f);
    const int sheet = addMaterial(scene, dense);
    addQuad(scene, addMaterial(scene, lambert(Rgb(kAlbedo))), {-9, 0, 9}, {18, 0, 0}, {0, 0, -18});
    addQuad(scene, sheet, {-99, 0.5f, up ? 50.0f : -50.0f}, {198, 0, 0},
            {0, 0, up ? -198.0f : 198.0f});
    passShadowsStraight(scene.materials);
    scene.lights.push_back(sun({0, -1, 0}, Rgb(2)));
    const Rgb found = radianceOf(scene, underTheSlab());
    for (int i = 0; i < 3; ++i) {
      EXPECT_TRUE(std::isfinite(found[i]));
      EXPECT_LE(found[i], kAlbedo / kPi * 2 * 0.9601f);
    }
  }
}

// A pane without another side: shadow rays and paths agree that it absorbs nothing.
TEST(SlowGlassShadows, OpenMeshesAbsorbNothing) {
  for (const bool up : {false, true}) {
    Scene scene;
    const int pane = addMaterial(scene, glass());
    addQuad(scene, addMaterial(scene, lambert(Rgb(kAlbedo))), {-9, 0, 9}, {18, 0, 0}, {0, 0, -18});
    addQuad(scene, pane, {-99, 0.5f, up ? 50.0f : -50.0f}, {198, 0, 0},
            {0, 0, up ? -198.0f : 198.0f});
    passShadowsStraight(scene.materials);
    const Probe probe(gradientProbe({32, 16}, Rgb(1), {0.2, 0.5, 0.1}));
    const auto mean = [&](const char* strategy) {
      return meanColor(
          renderScene(scene, underTheSlab(), probe, strategy, smallRender(8, 8, 4096, 1))
              .film.mean());
    };
    const Rgb expected = mean("bsdf");
    for (const char* strategy : {"uniform", "importance", "suns"})
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(mean(strategy)[i] / expected[i], 1, 0.01) << strategy;
  }
}

// Lamps and narrow lobes: paths and shadow rays do not both find the light.
TEST(SlowGlassShadows, NarrowLobesAgreeWithBroadOnes) {
  Scene scene = floorAndSlab(0.5f, 1.25f);
  scene.materials[1].metallic = 1;
  scene.materials[1].roughness = 0.1f;
  scene.materials[1].specular = 1;
  Material lamp = lambert(Rgb(0));
  lamp.emission = Rgb(5);
  addQuad(scene, addMaterial(scene, lamp), {-20, 3, -20}, {40, 0, 0}, {0, 0, 40});
  const Probe dark(constantProbe({4, 2}, Rgb(1e-6f)));
  const auto mean = [&](const char* strategy) {
    return meanColor(
        renderScene(scene, underTheSlab(), dark, strategy, smallRender(8, 8, 4096, 2)).film.mean());
  };
  const Rgb expected = mean("importance");
  EXPECT_GT(expected.x, 0.01f);
  EXPECT_NEAR(mean("median-cut:8").x / expected.x, 1, 0.01);
}

// Rough, coated and blended glass blocks light.
TEST(GlassShadows, OnlySmoothGlassLetsLightPass) {
  Material rough = glass(), coated = glass(), blended = glass();
  rough.roughness = 0.2f;
  coated.extended->clearcoat = 1;
  blended.alphaMode = AlphaMode::Blend;
  for (const Material& material : {rough, coated, blended}) {
    Scene scene = floorAndSlab(0.5f, 1.25f, material);
    scene.lights.push_back(sun({0, -1, 0}, Rgb(2)));
    EXPECT_EQ(radianceOf(scene, underTheSlab()), Rgb(0));
  }
  Scene scene = floorAndSlab(0.5f, 1.25f);
  for (Material& material : scene.materials) material.straightShadows = false;
  scene.lights.push_back(sun({0, -1, 0}, Rgb(2)));
  EXPECT_EQ(radianceOf(scene, underTheSlab()), Rgb(0));
}

// A roughness below 0.01 counts as 0.
TEST(GlassShadows, NearlySmoothGlassIsSmooth) {
  const auto floorUnder = [](const Material& material) {
    Scene scene = floorAndSlab(0.5f, 1.25f, material);
    scene.lights.push_back(sun({0, -1, 0}, Rgb(2)));
    return radianceOf(scene, underTheSlab());
  };
  Material sheet = glass(), body = glass();
  sheet.extended->thinWalled = true;
  for (Material& material : {std::ref(sheet), std::ref(body)}) {
    const Rgb smooth = floorUnder(material);
    EXPECT_GT(smooth.x, 0.5f * kAlbedo / kPi);
    material.roughness = 0.009f;
    EXPECT_EQ(floorUnder(material), smooth);
  }
}

// Where a texture makes a sheet smooth, light passes, and only there.
TEST(GlassShadows, ATextureMakesASheetSmooth) {
  Material sheet = glass();
  sheet.extended->thinWalled = true;
  sheet.roughness = 1;
  sheet.metallicRoughnessTexture.texture = 0;
  for (const uint8_t roughness : std::to_array<uint8_t>({0, 2, 3, 255})) {
    Scene scene = floorAndSlab(0.5f, 1.25f);
    scene.materials[0] = sheet;
    scene.grids.push_back(
        std::make_unique<TexelGrid>(TexelGrid{1, 1, {{0, roughness, 0, 255}}, {}}));
    scene.textures.push_back({scene.grids.back().get()});
    scene.lights.push_back(sun({0, -1, 0}, Rgb(2)));
    const float passed = roughness / 255.0f < 0.01f ? 0.96f * 0.96f : 0;
    EXPECT_NEAR(radianceOf(scene, underTheSlab()).x / (kAlbedo / kPi * 2), passed, 1e-4f)
        << int(roughness);
  }
}

// The camera's view through glass is still refracted.
TEST(GlassShadows, TheCameraSeesRefraction) {
  const Probe probe(studioProbe({64, 32}));
  Scene scene;
  addSphere(scene, addMaterial(scene, glass()), vec3(0), 1, 32);
  const auto render = [&] {
    return renderScene(scene, topCamera(4, 40), probe, "importance", smallRender(16, 16, 16, 8))
        .film.mean()
        .texels;
  };
  const auto refracted = render();
  passShadowsStraight(scene.materials);
  EXPECT_EQ(render(), refracted);
}

}  // namespace
}  // namespace chromeball::glass_shadows_test
