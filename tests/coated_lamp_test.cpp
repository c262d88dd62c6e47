// SPDX-License-Identifier: Apache-2.0
// Emission under a clear coat (KHR_materials_clearcoat): emission x (1 - clearcoat x Fresnel).
#include <gtest/gtest.h>

#include "probe/synth.h"
#include "test_scene.h"

namespace chromeball::coated_lamp_test {
namespace {

Material lamp(float clearcoat) {
  Material m = lambert(Rgb(0));
  m.emission = Rgb(3, 2, 1);
  m.extended.emplace();
  m.extended->clearcoat = clearcoat;
  return m;
}

// The transmittance with Schlick's Fresnel term for ior 1.5.
double coatTransmittance(double clearcoat, double cosine) {
  return 1 - clearcoat * (0.04 + 0.96 * std::pow(1 - cosine, 5));
}

// Radiance of a tile of a lamp seen at an angle to its normal, under a black probe.
Rgb radianceAt(const Scene& scene, double degrees) {
  const double a = degrees * kPiD / 180;
  Camera camera = Camera::lookAt({0, 4 * float(std::cos(a)), 4 * float(std::sin(a))}, vec3(0),
                                 {0, 0, -1}, 0.1f);
  camera.orthographic = true;
  camera.halfHeight = 0.05f;
  const Probe black(constantProbe({4, 2}, Rgb(0)));
  return meanColor(
      renderScene(scene, camera, black, "importance", smallRender(4, 4, 4, 0)).film.mean());
}

void addTile(Scene& scene, int material) {
  addQuad(scene, material, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
}

TEST(CoatedLamp, EmissionIsScaledByTheCoatsTransmittance) {
  for (const float clearcoat : {0.0f, 0.5f, 1.0f})
    for (const double degrees : {0.0, 45.0, 85.0}) {
      Scene scene;
      addTile(scene, addMaterial(scene, lamp(clearcoat)));
      const Rgb found = radianceAt(scene, degrees);
      const double expected = coatTransmittance(clearcoat, std::cos(degrees * kPiD / 180));
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c] / (3 - c), expected, 1e-4) << degrees;
    }
}

// Adds a texture of one texel.
TextureSlot addTexel(Scene& scene, const vec4& color) {
  auto grid = std::make_unique<TexelGrid>();
  grid->width = grid->height = 1;
  grid->texelsFloat = {color};
  scene.textures.push_back({grid.get()});
  scene.grids.push_back(std::move(grid));
  TextureSlot slot;
  slot.texture = int(scene.textures.size()) - 1;
  return slot;
}

// The coat's texture and normal map affect the emission, the base's normal map does not.
TEST(CoatedLamp, UsesTheCoatsTextureAndNormal) {
  const float tilt = float(0.6 * kPiD / 2);
  for (const bool tilted : {false, true}) {
    Scene scene;
    Material m = lamp(0.8f);
    m.extended->clearcoatTexture = addTexel(scene, {0.5f, 0, 0, 1});
    const TextureSlot tiltedNormal =
        addTexel(scene, {0.5f, 0.5f - 0.5f * std::sin(tilt), 0.5f + 0.5f * std::cos(tilt), 1});
    (tilted ? m.extended->clearcoatNormalTexture : m.normalTexture) = tiltedNormal;
    Mesh mesh;
    mesh.positions = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.normals.assign(4, {0, 1, 0});
    mesh.tangents.assign(4, {1, 0, 0, 1});  // the bitangent points to -Z, away from the camera
    mesh.uvs.assign(1, std::vector<vec2>(4, vec2(0.5f)));
    addMesh(scene, addMaterial(scene, m), std::move(mesh));
    const double degrees = 20;
    const double cosine = std::cos(degrees * kPiD / 180 - (tilted ? double(tilt) : 0));
    EXPECT_NEAR(radianceAt(scene, degrees).y / 2, coatTransmittance(0.4, cosine), 1e-3) << tilted;
  }
}

// Unlit surfaces have no coat; the coat of a transmissive body is only on its outer side.
TEST(CoatedLamp, UnlitSurfacesAndInnerSidesHaveNoCoat) {
  Material unlit = lamp(1);
  unlit.unlit = true;
  unlit.baseColor = {0.3f, 0.6f, 0.9f, 1};
  Scene scene;
  addTile(scene, addMaterial(scene, unlit));
  EXPECT_NEAR(radianceAt(scene, 70).y, 0.6f, 1e-6f);

  Material body = lamp(1);
  body.extended->transmission = 1;
  body.extended->thinWalled = false;
  Scene inside;
  addQuad(inside, addMaterial(inside, body), {-1, 0, 1}, {0, 0, -2}, {2, 0, 0});
  EXPECT_NEAR(radianceAt(inside, 70).y, 2, 1e-5f);
}

// Light samples and BSDF samples use the same emission: the irradiance of a floor beside the lamp
// is
//   E = integral over the lamp of L coatTransmittance(cos') cos cos' / d^2 dA.
TEST(CoatedLamp, LightSamplesMatchTheIntegral) {
  constexpr double kHeight = 0.5, kAside = 1.5;  // of the lamp's centre; the lamp is 1 m x 1 m
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(1))), {-0.01f, 0, 0.01f}, {0.02f, 0, 0},
          {0, 0, -0.02f});
  addQuad(scene, addMaterial(scene, lamp(1)), {kAside - 0.5f, kHeight, -0.5f}, {1, 0, 0},
          {0, 0, 1});
  constexpr int kGrid = 400;
  double expected = 0;
  for (int i = 0; i < kGrid; ++i)
    for (int j = 0; j < kGrid; ++j) {
      const double x = kAside - 0.5 + (i + 0.5) / kGrid, z = -0.5 + (j + 0.5) / kGrid;
      const double d2 = x * x + kHeight * kHeight + z * z, cosine = kHeight / std::sqrt(d2);
      expected += 2 * coatTransmittance(1, cosine) * cosine * cosine / d2 / (double(kGrid) * kGrid);
    }
  Camera camera = topCamera(0.4f, 1);
  const Probe black(constantProbe({4, 2}, Rgb(0)));
  for (const Mis mis : {Mis::Off, Mis::Balance, Mis::Power}) {
    RenderSettings settings = smallRender(8, 8, 1024, 1);
    settings.mis = mis;
    const Image image = renderScene(scene, camera, black, "importance", settings).film.mean();
    EXPECT_NEAR(meanColor(image).y * kPiD / expected, 1, 3e-3) << int(mis);
  }
}

}  // namespace
}  // namespace chromeball::coated_lamp_test
