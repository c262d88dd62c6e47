// SPDX-License-Identifier: Apache-2.0
// Environment mapping and ambient occlusion as integrators: right on convex objects, furnaces, and
// what they miss elsewhere.
#include <gtest/gtest.h>

#include "approximate/environment_map.h"
#include "base/parallel.h"
#include "math/vec.h"
#include "probe/sun_extraction.h"
#include "probe/synth.h"
#include "study/study.h"
#include "test_probes.h"
#include "test_scene.h"

namespace chromeball::environment_map_test {
namespace {

RenderResult renderRow(const std::string& name, const Scene& scene, const Camera& camera,
                       const Probe& probe, uint32_t samples, int size = 24) {
  const Row row = rowNamed(name, "test");
  const RenderSettings settings = row.applied(smallRender(size, size, samples, 8));
  const World world(scene, {}, allTables());
  const auto lighting = makeStrategy(row.strategy, probe, Mis::Balance, "test");
  const EnvironmentLight environment(probe, scene, row.strategy == "suns");
  const std::atomic<bool> never = false;
  return render(world, camera, *lighting, settings, [](double) {}, never, nullptr, {&environment});
}

Scene sphereOf(const Material& material) {
  Scene scene;
  addSphere(scene, addMaterial(scene, material), {0, 0, 0}, 1, 96);
  return scene;
}

Camera towardsOrigin() { return Camera::lookAt({0, 0.5f, 3}, {0, 0, 0}, {0, 1, 0}, 0.8f); }

// Mean relative difference of luminance.
double difference(const Image& a, const Image& b) {
  double sum = 0, all = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      sum += std::abs(luminance(a.rgb(x, y)) - luminance(b.rgb(x, y)));
      all += luminance(b.rgb(x, y));
    }
  return sum / all;
}

Material metal(float roughness) {
  Material m;
  m.baseColor = {1, 0.8f, 0.4f, 1};
  m.roughness = roughness;
  return m;
}

TEST(EnvironmentMap, AConvexMirrorShowsWhatPathsSee) {
  const Scene scene = sphereOf(metal(0));
  const Probe probe(studioProbe({128, 64}));
  const Image mapped =
      renderRow("importance+environment-map", scene, towardsOrigin(), probe, 16).film.mean();
  const Image traced = renderRow("importance", scene, towardsOrigin(), probe, 16).film.mean();
  EXPECT_LT(difference(mapped, traced), 1e-4);
}

TEST(EnvironmentMap, AConvexMatteSphereIsRight) {
  const Scene scene = sphereOf(lambert({0.8f, 0.5f, 0.3f}));
  const Probe probe(gradientProbe({64, 32}, Rgb(0.5f), {0.2, 0.3, 0.1}));
  const Image mapped =
      renderRow("importance+environment-map", scene, towardsOrigin(), probe, 64).film.mean();
  const Image traced = renderRow("importance", scene, towardsOrigin(), probe, 1024).film.mean();
  EXPECT_LT(difference(mapped, traced), 3e-3);  // the noise of the traced picture
  EXPECT_NEAR(luminance(meanColor(mapped)) / luminance(meanColor(traced)), 1, 1e-3);
}

TEST(EnvironmentMap, AConvexRoughMetalIsNearlyRight) {
  for (const float roughness : {0.1f, 0.4f, 0.7f, 1.0f}) {
    const Scene scene = sphereOf(metal(roughness));
    const Probe probe(gradientProbe({64, 32}, Rgb(0.5f), {0.2, 0.3, 0.1}));
    const Image mapped =
        renderRow("importance+environment-map", scene, towardsOrigin(), probe, 16).film.mean();
    const Image traced = renderRow("importance", scene, towardsOrigin(), probe, 256).film.mean();
    EXPECT_LT(difference(mapped, traced), 0.04) << roughness;
  }
}

// White materials of all kinds reflect all of a constant environment.
TEST(EnvironmentMap, ConvexWhiteObjectsVanishInAFurnace) {
  std::vector<Material> materials;
  for (const float metallic : {0.0f, 0.5f, 1.0f})
    for (const float roughness : {0.0f, 0.1f, 0.5f, 1.0f}) {
      Material m;
      m.metallic = metallic, m.roughness = roughness;
      materials.push_back(m);
    }
  Material coated = materials.front();
  coated.extended.emplace();
  coated.extended->clearcoat = 1;
  coated.extended->clearcoatRoughness = 0.6f;
  materials.push_back(coated);
  Material cloth = lambert(Rgb(1));
  cloth.extended.emplace();
  cloth.extended->sheenColor = Rgb(1);
  cloth.extended->sheenRoughness = 0.5f;
  materials.push_back(cloth);
  Material brushed;
  brushed.roughness = 0.5f;
  brushed.extended.emplace();
  brushed.extended->anisotropy = 0.8f;
  materials.push_back(brushed);
  Material glass = materials.front();
  glass.extended.emplace();
  glass.extended->transmission = 1;
  glass.extended->thinWalled = false;
  materials.push_back(glass);
  glass.extended->thinWalled = true;
  materials.push_back(glass);

  const Probe white(constantProbe({16, 8}, Rgb(1)));
  for (size_t i = 0; i < materials.size(); ++i) {
    const Image picture = renderRow("importance+environment-map", sphereOf(materials[i]),
                                    towardsOrigin(), white, 4, 12)
                              .film.mean();
    for (const float texel : picture.texels) ASSERT_NEAR(texel, 1, 0.012f) << "material " << i;
  }
}

// The error that the text names: cavities are as bright as open surfaces. Occlusion makes them
// darker than the truth, since interreflection is missing.
TEST(EnvironmentMap, CavitiesAreTooBrightAndOccludedOnesTooDark) {
  Scene scene;
  const int grey = addMaterial(scene, lambert(Rgb(0.7f)));
  addQuad(scene, grey, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
  addQuad(scene, grey, {-1, 0, 1}, {0, 0, -2}, {0, 2, 0});
  addQuad(scene, grey, {1, 0, 1}, {0, 0, -2}, {0, 2, 0});
  addQuad(scene, grey, {-1, 0, -1}, {2, 0, 0}, {0, 2, 0});
  const Camera camera = topCamera(4, 20);
  const Probe white(constantProbe({16, 8}, Rgb(1)));
  const auto mean = [&](const char* row) {
    return luminance(meanColor(renderRow(row, scene, camera, white, 64).film.mean()));
  };
  const double truth = mean("importance"), mapped = mean("importance+environment-map");
  const double occluded = mean("importance+ambient-occlusion");
  EXPECT_NEAR(mapped, 0.7, 1e-3);
  EXPECT_GT(mapped, 1.1 * truth);
  EXPECT_LT(occluded, 0.95 * truth);
  // Ambient occlusion accounts for one bounce only.
  EXPECT_NEAR(occluded, mean("importance+direct"), 5e-3);
  EXPECT_EQ(mean("importance+environment-map+ao"), occluded);
}

// A mirror under a black roof reflects the sky if geometry does not block.
TEST(EnvironmentMap, ReflectionOcclusionShowsWhatBlocks) {
  Scene scene;
  addQuad(scene, addMaterial(scene, metal(0)), {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
  addQuad(scene, addMaterial(scene, lambert(Rgb(0))), {-50, 1, -50}, {100, 0, 0}, {0, 0, 100});
  const Camera camera = topCamera(0.5f, 20);
  const Probe white(constantProbe({16, 8}, Rgb(1)));
  const auto green = [&](const char* row) {
    return meanColor(renderRow(row, scene, camera, white, 4).film.mean()).x;
  };
  EXPECT_NEAR(green("importance+environment-map"), 1, 1e-3);
  EXPECT_EQ(green("importance+environment-map+reflection-occlusion"), 0);
}

TEST(EnvironmentMap, ShowsEmissionAloneWithoutBounces) {
  Material glowing = metal(0.4f);
  glowing.emission = Rgb(0.25f);
  const Scene scene = sphereOf(glowing);
  const Probe probe(constantProbe({16, 8}, Rgb(1)));
  const EnvironmentLight environment(probe, scene, false);
  const World world(scene, {}, allTables());
  const auto lighting = makeStrategy("importance", probe, Mis::Balance, "test");
  const std::atomic<bool> never = false;
  for (const auto kind : {IntegratorKind::EnvironmentMap, IntegratorKind::AmbientOcclusion}) {
    RenderSettings settings = smallRender(8, 8, 4, 0);
    settings.integrator = kind;
    const Camera camera = Camera::lookAt({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.1f);
    EXPECT_EQ(meanColor(render(world, camera, *lighting, settings, [](double) {}, never, nullptr,
                               {&environment})
                            .film.mean()),
              Rgb(0.25f));
  }
}

// Suns and ambient light of the scene: in smooth lobes as the camera sees them, in others all of
// them.
TEST(SlowEnvironmentMap, ConvexObjectsShowTheLightOfTheScene) {
  Material coated = lambert(Rgb(0.3f));
  coated.extended.emplace();
  coated.extended->clearcoat = 1;
  Material plastic = lambert(Rgb(0.5f));
  plastic.specular = 1;
  plastic.roughness = 0.5f;
  const Probe probe(gradientProbe({32, 16}, Rgb(0.2f), {0.05, 0.1, 0.02}));
  const vec3 towards = glm::normalize(vec3(0.5f, 0.6f, 0.6f));
  for (const bool isVisible : {true, false})
    for (const Material& material : {metal(0), coated, plastic, metal(0.1f)}) {
      Scene scene = sphereOf(material);
      scene.ambient.push_back({Rgb(0.4f, 0.5f, 0.6f), isVisible, "ambient"});
      scene.suns.push_back({Sun{towards, glm::dvec3(0.8), 20}, isVisible, "sun"});
      const auto mean = [&](const char* row, uint32_t samples) {
        return meanColor(renderRow(row, scene, towardsOrigin(), probe, samples).film.mean());
      };
      const Rgb mapped = mean("importance+environment-map", 64), traced = mean("importance", 1024);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(mapped[c] / traced[c], 1, 0.03) << material.roughness << isVisible;
    }
}

// With `suns` the sun is a light with shadows: on open ground the picture is right, under a roof it
// is dark.
TEST(EnvironmentMap, SunsCastShadows) {
  Image map = constantProbe({256, 128}, Rgb(0.5f));
  map.setRgb(40, 20, Rgb(1e5f));
  const Probe probe(map);
  Scene open;
  addQuad(open, addMaterial(open, lambert(Rgb(0.5f))), {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
  const auto mean = [&](const char* row, const Scene& scene) {
    return luminance(meanColor(renderRow(row, scene, topCamera(1, 20), probe, 64).film.mean()));
  };
  EXPECT_NEAR(mean("suns+ambient-occlusion", open) / mean("importance", open), 1, 0.01);
  Scene roofed = open;
  addQuad(roofed, 0, {-50, 2, -50}, {100, 0, 0}, {0, 0, 100});
  EXPECT_LT(mean("suns+ambient-occlusion", roofed), 0.02 * mean("suns+ambient-occlusion", open));
}

// The suns look like the discs of the strategy `suns`: E / (pi sin^2(angle / 2)) within the given
// diameter.
TEST(EnvironmentMap, SunsHaveTheGivenAngle) {
  Image map = constantProbe({256, 128}, Rgb(0.5f));
  map.setRgb(40, 20, Rgb(1e5f));
  const Probe probe(map);
  const Sun sun = extractSuns(map).suns.at(0);
  const EnvironmentLight environment(probe, Scene(), true, 30.0);
  for (const double degrees : {0.0, 14.0, 16.0}) {
    const Frame frame(vec3(sun.direction));
    const double angle = glm::radians(degrees);
    const vec3 wi = frame.toWorld({float(std::sin(angle)), 0, float(std::cos(angle))});
    const double radiance = sun.irradiance.x / (kPiD * std::pow(std::sin(glm::radians(15.0)), 2));
    EXPECT_NEAR(environment.suns()->background(vec3(0), wi).x, degrees < 15 ? radiance : 0,
                1e-4 * radiance)
        << degrees;
  }
}

TEST(EnvironmentMap, BearsExtremesAndAnyThreadCount) {
  Scene scene = sphereOf(metal(0.5f));
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {-3, -1, 3}, {6, 0, 0}, {0, 0, -6});
  for (const char* row : {"importance+environment-map", "suns+ambient-occlusion"}) {
    const auto picture = [&](float scale, size_t threads) {
      const ThreadLimit limit(threads);
      const Probe probe(spot(64, 32, 40, 6, 500 * scale, 0.2f * scale));
      const RenderResult result = renderRow(row, scene, towardsOrigin(), probe, 8);
      EXPECT_EQ(result.invalid.total(), 0u);
      return result.film.mean();
    };
    const Image expected = picture(1, 2);
    EXPECT_EQ(expected.texels, picture(1, 1).texels);
    for (const float scale : {1e-8f, 1e10f})
      EXPECT_NEAR(luminance(meanColor(picture(scale, 2))) / scale / luminance(meanColor(expected)),
                  1, 1e-3);
  }
}

// Path tracing of one bounce.
TEST(DirectIntegrator, EqualsPathsOfDepthOne) {
  const Scene scene = sphereOf(lambert(Rgb(0.5f)));
  const Probe probe(studioProbe({64, 32}));
  const Image direct = renderRow("importance+direct", scene, towardsOrigin(), probe, 8).film.mean();
  const RenderSettings one = rowNamed("importance", "test").applied(smallRender(24, 24, 8, 1));
  EXPECT_EQ(direct.texels,
            renderScene(scene, towardsOrigin(), probe, "importance", one).film.mean().texels);
}

TEST(Row, NamesOfIntegratorsAndDepthsRoundTrip) {
  for (const char* name :
       {"importance", "suns+ambient-occlusion", "median-cut:64+environment-map+denoise+ao",
        "importance+direct", "importance+diffuse-depth:6+specular-depth:2",
        "importance+guide+denoise+irradiance-cache:0.25"})
    EXPECT_EQ(rowNamed(name, "test").name(), name);
  EXPECT_EQ(rowNamed("importance+path", "test").name(), "importance");
  for (const char* name : {"importance+ao", "importance+environment-map+guide",
                           "importance+diffuse-depth:", "importance+diffuse-depth:-1",
                           "importance+diffuse-depth:2x", "importance+raster"})
    EXPECT_THROW(rowNamed(name, "test"), std::runtime_error) << name;
}

}  // namespace
}  // namespace chromeball::environment_map_test
