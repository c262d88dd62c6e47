// SPDX-License-Identifier: Apache-2.0
// Limits of path length: which bounces they count, and how much light they cut.
#include <gtest/gtest.h>

#include "base/json.h"
#include "composite/render_composite.h"
#include "gltf_writer.h"
#include "json_file.h"
#include "probe/synth.h"
#include "run_command.h"
#include "test_scene.h"

namespace chromeball::depth_test {
namespace {

Probe whiteProbe() { return Probe(constantProbe({64, 32}, Rgb(1))); }

Material glass(float roughness) {
  Material m;
  m.metallic = 0;
  m.roughness = roughness;
  m.extended.emplace();
  m.extended->transmission = 1;
  m.extended->thinWalled = false;
  return m;
}

// A hollow glass ball; its walls guide light along the rim, by long paths of total reflection.
Scene vase(float roughness) {
  Scene scene;
  const int material = addMaterial(scene, glass(roughness));
  addSphere(scene, material, vec3(0), 1, 48);
  addSphere(scene, material, vec3(0), -0.85f, 48);
  return scene;
}

RenderResult renderTop(const Scene& scene, RenderSettings settings,
                       const Probe& probe = whiteProbe()) {
  return renderScene(scene, topCamera(4, 30), probe, "importance", settings);
}

// White furnace test: only the light that the default limits cut is missing.
TEST(Depth, AVaseAtTheDefaultDepthPassesTheWhiteFurnaceTest) {
  for (const float roughness : {0.0f, 0.2f}) {
    const RenderResult r = renderTop(vase(roughness), smallRender(16, 16, 40, 8));
    const Image image = r.film.mean();
    EXPECT_NEAR(meanColor(image).y, 1, roughness > 0 ? 0.01 : 0.003) << roughness;
    float darkest = 1;
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) darkest = std::min(darkest, image.rgb(x, y).y);
    EXPECT_GT(darkest, 0.85f) << roughness;
  }
}

TEST(Depth, TransmissiveBodiesHaveTheirOwnLimit) {
  RenderSettings settings = smallRender(16, 16, 64, 8);
  settings.maxTransmissionDepth = 2;
  const RenderResult r = renderTop(vase(0), settings);
  EXPECT_LT(meanColor(r.film.mean()).y, 0.85f);
  const DepthCut& cut = r.depthCut;
  EXPECT_EQ(cut.fraction(DepthLimit::Depth), 0);
  EXPECT_NEAR(cut.fraction(DepthLimit::Transmission), 1 - meanColor(r.film.mean()).y, 0.03);
}

// Bounces on other materials count for maxDepth: 0 is visible emission only, 1 adds direct light.
TEST(Depth, MirrorsAndMatteSurfacesCountForMaxDepth) {
  Material mirror;
  mirror.roughness = 0;
  for (const Material& m : {mirror, lambert(Rgb(1))}) {
    Scene scene;
    addQuad(scene, addMaterial(scene, m), {-9, 0, 9}, {18, 0, 0}, {0, 0, -18});
    EXPECT_EQ(meanColor(renderTop(scene, smallRender(4, 4, 16, 0)).film.mean()).y, 0);
    EXPECT_NEAR(meanColor(renderTop(scene, smallRender(4, 4, 256, 1)).film.mean()).y, 1, 0.01);
  }
}

// A floor below a pane: with maxDepth 1, the only counted bounce is that on the floor, because
// refraction by the pane does not count. Light reflected by the pane onto the floor needs two.
TEST(Depth, RefractionDoesNotCountForMaxDepth) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {-9, 0, 9}, {18, 0, 0}, {0, 0, -18});
  const int pane = addMaterial(scene, glass(0));
  addQuad(scene, pane, {-9, 2, 9}, {18, 0, 0}, {0, 0, -18});
  addQuad(scene, pane, {-9, 1.9f, -9}, {18, 0, 0}, {0, 0, 18});
  // With depth 1 the floor is lit through the pane only; with depth 2 also by its own reflection in
  // the pane.
  const auto mean = [&](int depth) {
    return meanColor(renderTop(scene, smallRender(8, 8, 256, depth)).film.mean()).y;
  };
  EXPECT_GT(mean(1), 0.4f);
  EXPECT_GT(mean(2), mean(1) + 0.01f);
}

// In a closed room of albedo a and uniform emission, d bounces find the fraction 1 - a^(d+1) of the
// light.
TEST(Depth, TheCutFractionIsEstimatedWithoutBias) {
  constexpr double kAlbedo = 0.7;
  Scene scene;
  Material wall = lambert(Rgb(float(kAlbedo)));
  wall.emission = Rgb(1);
  addSphere(scene, addMaterial(scene, wall), vec3(0), -5, 16, false);
  for (const auto& [depth, transmissions] : {std::pair(1, 64), std::pair(3, 64), std::pair(3, 0)}) {
    RenderSettings settings = smallRender(16, 16, 512, depth);
    settings.maxTransmissionDepth = transmissions;  // reached by no path: there is no glass
    const RenderResult r = renderTop(scene, settings);
    const DepthCut& cut = r.depthCut;
    const double expected = std::pow(kAlbedo, depth + 1);
    EXPECT_NEAR(cut.fraction(DepthLimit::Depth) / expected, 1, 0.12) << depth;
    EXPECT_EQ(cut.fraction(DepthLimit::Transmission), 0);
    EXPECT_NEAR(meanColor(r.film.mean()).y, (1 - expected) / (1 - kAlbedo), 0.02);
  }
}

// Half of the view is a room, whose noise draws samples, half an even panel.
TEST(SlowDepth, TheCutFractionIsThatOfTheImageWhereSamplesAreAdaptive) {
  Scene scene;
  addSphere(scene, addMaterial(scene, lambert(Rgb(0.7f))), vec3(0), -5, 16, false);
  Material lamp = lambert(Rgb(0)), panel = lamp;
  lamp.emission = Rgb(30), panel.emission = Rgb(1);
  addQuad(scene, addMaterial(scene, lamp), {-0.5f, 4, -0.5f}, {1, 0, 0}, {0, 0, 1});
  addQuad(scene, addMaterial(scene, panel), {-2.5f, -2.5f, 1}, {2.5f, 0, 0}, {0, 5, 0});
  const Camera camera = Camera::lookAt({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 1);
  double fractions[2];
  for (const bool adaptive : {false, true}) {
    RenderSettings settings = smallRender(48, 48, 256, 1);
    settings.adaptive = adaptive;
    fractions[adaptive] = renderScene(scene, camera, whiteProbe(), "importance", settings)
                              .depthCut.fraction(DepthLimit::Depth);
  }
  EXPECT_GT(fractions[0], 0.1);
  EXPECT_NEAR(fractions[1] / fractions[0], 1, 0.1) << fractions[0];
}

TEST(Depth, NothingIsCutInAConvexOpenScene) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {-9, 0, 9}, {18, 0, 0}, {0, 0, -18});
  const DepthCut cut = renderTop(scene, smallRender(16, 16, 64, 1)).depthCut;
  EXPECT_EQ(cut.fraction(DepthLimit::Depth), 0);
  EXPECT_GT(cut.found, 0);
}

TEST(Depth, LargestLimitsDoNotOverflow) {
  RenderSettings settings = smallRender(8, 8, 16, INT_MAX);
  settings.maxTransmissionDepth = INT_MAX;
  Scene scene = vase(0);
  scene.materials[0].extended->attenuation = Rgb(1);
  EXPECT_GT(meanColor(renderTop(scene, settings).film.mean()).y, 0.3f);
}

// The paths of composites have the same limits, with one pass and with two.
TEST(Depth, AVaseInACompositePassesTheWhiteFurnaceTest) {
  Scene scene = vase(0);
  addQuad(scene, addMaterial(scene, lambert(Rgb(1))), {-9, -40, 9}, {18, 0, 0}, {0, 0, -18});
  const ObjectMask isObject{true, true, false};
  const Probe probe = whiteProbe();
  const World world(scene, rayMasks(isObject), allTables());
  const RenderSettings settings = smallRender(8, 8, 64, 8);
  const auto lighting = makeStrategy("importance", probe, settings.mis, "test");
  const std::atomic<bool> stop = false;
  const Camera rim = Camera::lookAt({0, 0.9f, 4}, {0, 0.9f, 0}, {0, 1, 0}, 0.07f);
  for (const Passes passes : {Passes::One, Passes::Two}) {
    const CompositeRender r = renderComposite(
        world, rim, *lighting, Image(8, 8, 3), settings, passes, false, [](double) {}, stop);
    glm::dvec3 objects(0);
    double covered = 0;
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) {
        objects += r.film().at(x, y).objects;
        covered += r.film().at(x, y).covered;
      }
    EXPECT_GT(covered, 0);
    // Camera rays see the black plate as background; rays reflected or refracted by glass see the
    // probe.
    EXPECT_NEAR(objects.y / covered, 1, 0.03) << int(passes);
  }
}

TEST(Depth, TheCommandReportsTheCutFraction) {
  GltfWriter w;  // a closed emissive room: a tetrahedron seen from inside
  w.add("materials", {{"doubleSided", true},
                      {"emissiveFactor", {1, 1, 1}},
                      {"pbrMetallicRoughness",
                       {{"metallicFactor", 0}, {"baseColorFactor", {0.8, 0.8, 0.8, 1}}}}});
  const int positions = w.vec3s({-9, -5, -9, 9, -5, -9, 0, -5, 9, 0, 9, 0});
  w.add("nodes", {{"mesh", w.mesh({{"attributes", {{"POSITION", positions}}},
                                   {"indices", w.indices({0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0})},
                                   {"material", 0}})}});
  w.add("cameras", {{"type", "perspective"},
                    {"perspective", {{"yfov", 0.6}, {"znear", 0.1}, {"aspectRatio", 1}}}});
  w.add("nodes", {{"camera", 0}});
  const TemporaryFolder folder;
  const auto render = [&](const char* depth) {
    const CommandResult r =
        runCommand({"render", w.save(), "-o", folder / "a.pfm", "--size", "16x16", "--samples",
                    "64", "--max-depth", depth, "--stats", folder / "a.json"});
    EXPECT_EQ(r.status, 0) << r.error;
    return r.error;
  };
  const std::string few = render("2");
  EXPECT_NE(few.find("warning: --max-depth 2 cut about "), std::string::npos) << few;
  const auto stats = jsonOfFile(folder / "a.json");
  EXPECT_NEAR(double(stats["depth_cut"]["max_depth"]), 0.512, 0.1);
  EXPECT_EQ(stats["depth_cut"]["max_transmission_depth"], 0);
  EXPECT_EQ(stats["max_transmission_depth"], 64);
  EXPECT_EQ(render("60").find("--max-depth"), std::string::npos);
  const CommandResult direct = runCommand({"render", w.save(), "-o", folder / "a.pfm", "--size",
                                           "16x16", "--samples", "64", "--integrator", "direct"});
  EXPECT_NE(direct.error.find("--integrator direct cut about "), std::string::npos) << direct.error;
  EXPECT_NE(direct.error.find("--integrator path keeps it"), std::string::npos) << direct.error;
  const CommandResult both =
      runCommand({"render", w.save(), "-o", folder / "a.pfm", "--size", "16x16", "--samples", "64",
                  "--integrator", "direct", "--max-depth", "1"});
  EXPECT_NE(both.error.find("--integrator path with a higher --max-depth keeps it"),
            std::string::npos)
      << both.error;
}

}  // namespace
}  // namespace chromeball::depth_test
