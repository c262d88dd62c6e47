// SPDX-License-Identifier: Apache-2.0
// The layers ao, bent_normal and irradiance against closed forms, and pictures relit from them.
#include <gtest/gtest.h>

#include <numeric>

#include "probe/irradiance.h"
#include "probe/synth.h"
#include "relight/stage/light_layers.h"
#include "test_scene.h"

namespace chromeball::surface_layers_test {
namespace {

RenderSettings withLayers(uint32_t samples, int maxDepth = 3) {
  RenderSettings settings = smallRender(8, 8, samples, maxDepth);
  settings.aovs = {Aov::Albedo, Aov::Normal, Aov::AmbientOcclusion, Aov::BentNormal,
                   Aov::Irradiance};
  return settings;
}

Probe white() { return Probe(constantProbe({16, 8}, Rgb(1))); }

Rgb meanOf(const RenderResult& result, Aov aov) {
  const Image image = result.aovs.finished(aov);
  return image.channels == 1
             ? Rgb(float(std::accumulate(image.texels.begin(), image.texels.end(), 0.0) /
                         double(image.texels.size())))
             : meanColor(image);
}

// A disc, as a fan of many triangles, faces down.
void addDisc(Scene& scene, int material, float height, float radius) {
  constexpr int kSides = 256;
  Mesh mesh;
  mesh.positions.push_back({0, height, 0});
  for (int i = 0; i < kSides; ++i) {
    const float phi = 2 * kPi * float(i) / kSides;
    mesh.positions.push_back({radius * std::cos(phi), height, radius * std::sin(phi)});
  }
  for (uint32_t i = 0; i < kSides; ++i) mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % kSides});
  addMesh(scene, material, std::move(mesh));
}

// Parts of renders store the numbers of layers: 0 to 12, in this order.
TEST(SurfaceLayers, NumbersAreThoseOfEarlierParts) {
  const char* names[] = {"albedo",  "normal",      "depth",     "alpha",   "variance",
                         "samples", "material",    "node",      "invalid", "denoise",
                         "ao",      "bent_normal", "irradiance"};
  ASSERT_EQ(allAovs().size(), std::size(names));
  for (size_t i = 0; i < std::size(names); ++i) {
    EXPECT_EQ(allAovs()[i].aov, Aov(i));
    EXPECT_EQ(allAovs()[i].name, std::string(names[i]));
  }
}

// ao = h^2 / (h^2 + R^2) below the middle of a disc.
TEST(SurfaceLayers, AmbientOcclusionBelowADisc) {
  for (const float radius : {0.5f, 1.0f, 2.0f}) {
    Scene scene;
    const int matte = addMaterial(scene, lambert(Rgb(0.5f)));
    addQuad(scene, matte, {-0.01f, 0, 0.01f}, {0.02f, 0, 0}, {0, 0, -0.02f});
    addDisc(scene, matte, 1, radius);
    const RenderResult result =
        renderScene(scene, topCamera(0.01f, 20), white(), "importance", withLayers(1024));
    EXPECT_NEAR(meanOf(result, Aov::AmbientOcclusion).x, 1 / (1 + radius * radius), 3e-3) << radius;
    const Rgb bent = meanOf(result, Aov::BentNormal);
    EXPECT_NEAR(bent.y, 1, 2e-3);
  }
}

// Half of the sky, and the mean direction (2/3, pi/3) in the plane of both normals; with constant
// weight, 45 degrees.
TEST(SurfaceLayers, AtTheFootOfAnInfiniteWall) {
  Scene scene;
  const int matte = addMaterial(scene, lambert(Rgb(0.5f)));
  addQuad(scene, matte, {0, 0, 1000}, {1000, 0, 0}, {0, 0, -2000});
  addQuad(scene, matte, {0, 0, 1000}, {0, 0, -2000}, {0, 1000, 0});
  const Camera camera = Camera::lookAt({1e-3f, 0.01f, 0}, {1e-3f, 0, 0}, {0, 0, -1}, 0.02f);
  RenderSettings settings = withLayers(1024);
  const RenderResult cosine = renderScene(scene, camera, white(), "importance", settings);
  EXPECT_NEAR(meanOf(cosine, Aov::AmbientOcclusion).x, 0.5, 3e-3);
  const vec3 expected = glm::normalize(vec3(2.0f / 3, kPi / 3, 0));
  EXPECT_LT(glm::distance(vec3(meanOf(cosine, Aov::BentNormal)), expected), 5e-3f);
  settings.occlusion.uniformBent = true;
  const RenderResult uniform = renderScene(scene, camera, white(), "importance", settings);
  EXPECT_LT(glm::distance(vec3(meanOf(uniform, Aov::BentNormal)),
                          vec3(std::sqrt(0.5f), std::sqrt(0.5f), 0)),
            5e-3f);
}

TEST(SurfaceLayers, WhatIsFartherThanTheDistanceDoesNotCount) {
  Scene scene;
  const int matte = addMaterial(scene, lambert(Rgb(0.5f)));
  addQuad(scene, matte, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
  addQuad(scene, matte, {-100, 2, -100}, {200, 0, 0}, {0, 0, 200});
  RenderSettings settings = withLayers(16);
  const Camera camera = topCamera(1, 20);
  EXPECT_LT(
      meanOf(renderScene(scene, camera, white(), "importance", settings), Aov::AmbientOcclusion).x,
      1e-2);
  settings.occlusion.distance = 1.5f;
  EXPECT_EQ(
      meanOf(renderScene(scene, camera, white(), "importance", settings), Aov::AmbientOcclusion).x,
      1);
}

TEST(SurfaceLayers, IrradianceOnOpenGround) {
  Scene scene;
  Material dark;  // its own colour and gloss do not matter
  dark.baseColor = {0.01f, 0.02f, 0.03f, 1};
  dark.roughness = 0.1f;
  addQuad(scene, addMaterial(scene, dark), {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
  const auto irradiance = [&](const Image& map) {
    const RenderResult result =
        renderScene(scene, topCamera(1, 20), Probe(map), "importance", withLayers(256));
    return meanOf(result, Aov::Irradiance);
  };
  EXPECT_NEAR(irradiance(constantProbe({16, 8}, Rgb(1))).y, kPi, 3e-3);
  const Image gradient = gradientProbe({64, 32}, Rgb(0.5f), {0.2, 0.3, 0.1});
  const vec3 up(0, 1, 0);
  EXPECT_NEAR(irradiance(gradient).y, exactIrradiance(gradient, {&up, 1})[0].y, 5e-3);
}

// The interreflection of the scene as it is: the wall's albedo matters, the floor's only by the
// second bounce.
TEST(SurfaceLayers, IrradianceIncludesInterreflection) {
  const auto onFloor = [](float wallAlbedo) {
    Scene scene;
    addQuad(scene, addMaterial(scene, lambert(Rgb(0))), {0, 0, 100}, {100, 0, 0}, {0, 0, -200});
    addQuad(scene, addMaterial(scene, lambert(Rgb(wallAlbedo))), {0, 0, 100}, {0, 0, -200},
            {0, 100, 0});
    const Camera camera = Camera::lookAt({1e-2f, 0.1f, 0}, {1e-2f, 0, 0}, {0, 0, -1}, 0.02f);
    return meanOf(renderScene(scene, camera, white(), "importance", withLayers(1024)),
                  Aov::Irradiance)
        .y;
  };
  EXPECT_NEAR(onFloor(0), kPi / 2, 0.02);
  // The wall sees half of the sky, and a black floor.
  EXPECT_NEAR(onFloor(0.8f), kPi / 2 * (1 + 0.8 * 0.5), 0.03);
}

TEST(SurfaceLayers, WithoutBouncesThereIsNoIrradiance) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
  const RenderResult result =
      renderScene(scene, topCamera(1, 20), white(), "importance", withLayers(8, 0));
  EXPECT_EQ(meanOf(result, Aov::Irradiance), Rgb(0));
}

// Their paths count neither for the estimate of the light cut off nor for what guides learn.
TEST(SlowSurfaceLayers, LeaveTheDepthCutAndTheGuidesAsTheyAre) {
  Scene scene;
  addSphere(scene, addMaterial(scene, lambert(Rgb(0.8f))), {0, 0, 0}, -1, 16);
  Material lamp = lambert(Rgb(0));
  lamp.emission = Rgb(1);
  addQuad(scene, addMaterial(scene, lamp), {-0.5f, 0.7f, -0.5f}, {1, 0, 0}, {0, 0, 1});
  const Camera camera = Camera::lookAt({0, 0, 0.8f}, {0, -0.2f, 0}, {0, 1, 0}, 1);
  const auto cutOf = [&](const RenderSettings& settings) {
    return renderScene(scene, camera, white(), "importance", settings).depthCut;
  };
  const DepthCut with = cutOf(withLayers(256)), without = cutOf(smallRender(8, 8, 256, 3));
  EXPECT_GT(without.fraction(DepthLimit::Depth), 0);
  EXPECT_NEAR(with.fraction(DepthLimit::Depth), without.fraction(DepthLimit::Depth), 1e-6);
  EXPECT_NEAR(with.found, without.found, 1e-6 * without.found);

  Scene room;  // with a window, which a guide finds
  const int grey = addMaterial(room, lambert(Rgb(0.5f)));
  addQuad(room, grey, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
  addQuad(room, grey, {-2, 0, -2}, {0, 0, 4}, {0, 3, 0});
  addQuad(room, grey, {-2, 3, -2}, {3, 0, 0}, {0, 0, 4});
  Image sky = constantProbe({32, 16}, Rgb(0.1f));
  sky.setRgb(24, 7, Rgb(300));
  const auto guided = [&](RenderSettings settings) {
    settings.width = settings.height = 32;
    settings.guiding = Guiding::On;
    return renderScene(room, topCamera(2.5f, 60), Probe(sky), "importance", settings);
  };
  const RenderResult alone = guided(smallRender(8, 8, 32, 3));
  EXPECT_GT(alone.guidedRegions, 0u);
  EXPECT_EQ(guided(withLayers(32)).film.mean().texels, alone.film.mean().texels);
}

TEST(SurfaceLayers, LeaveThePictureAsItIs) {
  Scene scene;
  addSphere(scene, addMaterial(scene, lambert(Rgb(0.5f))), {0, 0, 0}, 1);
  const Camera camera = Camera::lookAt({0, 0.5f, 3}, {0, 0, 0}, {0, 1, 0}, 0.8f);
  const auto picture = [&](const RenderSettings& settings) {
    return renderScene(scene, camera, Probe(studioProbe({64, 32})), "importance", settings)
        .film.mean()
        .texels;
  };
  EXPECT_EQ(picture(withLayers(32)), picture(smallRender(8, 8, 32, 3)));
}

OcclusionLayers layersOf(const RenderResult& result, Aov normal) {
  return {result.aovs.finished(Aov::Albedo), result.aovs.finished(normal),
          result.aovs.finished(Aov::AmbientOcclusion)};
}

// A convex object, with any normal; and any object under a constant probe.
TEST(Relit, EqualsTheRenderWhereItShould) {
  Scene sphere;
  addSphere(sphere, addMaterial(sphere, lambert({0.8f, 0.5f, 0.3f})), {0, 0, 0}, 1, 96);
  const Camera camera = Camera::lookAt({0, 0.5f, 3}, {0, 0, 0}, {0, 1, 0}, 0.2f);
  const Image gradient = gradientProbe({64, 32}, Rgb(0.5f), {0.2, 0.3, 0.1});
  const Rotation rotation(70);
  const RenderResult traced =
      renderScene(sphere, camera, Probe(gradient, rotation), "importance", withLayers(1024, 1));
  const Image relitPicture = relit(layersOf(traced, Aov::Normal), gradient, rotation);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(meanColor(relitPicture)[c] / meanColor(traced.film.mean())[c], 1, 2e-3);

  Scene corner;
  const int matte = addMaterial(corner, lambert(Rgb(0.5f)));
  addQuad(corner, matte, {0, 0, 1}, {1, 0, 0}, {0, 0, -2});
  addQuad(corner, matte, {0, 0, 1}, {0, 0, -2}, {0, 1, 0});
  const Camera close = Camera::lookAt({0.3f, 0.4f, 0}, {0.2f, 0, 0}, {0, 0, -1}, 0.3f);
  const Image constant = constantProbe({16, 8}, Rgb(1));
  const RenderResult oneBounce =
      renderScene(corner, close, Probe(constant), "importance", withLayers(1024, 1));
  for (const Aov normal : {Aov::Normal, Aov::BentNormal})
    EXPECT_NEAR(meanColor(relit(layersOf(oneBounce, normal), constant, {})).x /
                    meanColor(oneBounce.film.mean()).x,
                1, 5e-3);
}

TEST(Relit, IsBlackWithoutASurface) {
  const OcclusionLayers none{Image(2, 2, 3), Image(2, 2, 3), Image(2, 2, 1)};
  for (const float texel : relit(none, constantProbe({16, 8}, Rgb(1)), {}).texels)
    EXPECT_EQ(texel, 0);
}

}  // namespace
}  // namespace chromeball::surface_layers_test
