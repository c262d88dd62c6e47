// SPDX-License-Identifier: Apache-2.0
// Punctual lights: closed forms of their falloff and of the radiance of a plane.
#include "lighting/scene_sources.h"

#include <gtest/gtest.h>

#include "composite/compose.h"
#include "composite/layers.h"
#include "composite/render_composite.h"
#include "gltf_writer.h"
#include "hypothesis.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "probe/synth.h"
#include "run_command.h"
#include "scene/gltf/load_gltf.h"
#include "test_scene.h"

namespace chromeball::punctual_test {
namespace {

using Kind = PunctualLight::Kind;
using nlohmann::json;

PunctualLight lampAt(vec3 position, Rgb intensity) {
  PunctualLight light;
  light.position = position;
  light.intensity = intensity;
  return light;
}

TEST(Punctual, InverseSquareAndRange) {
  PunctualLight light = lampAt({0, 3, 0}, Rgb(18, 9, 0));
  const DirectionSample s = incidentLight(light, {0, 0, 0});
  EXPECT_EQ(s.wi, vec3(0, 1, 0));
  EXPECT_EQ(s.distance, 3);
  EXPECT_NEAR(glm::distance(s.irradiance, Rgb(2, 1, 0)), 0, 1e-6);
  light.range = 6;
  EXPECT_NEAR(incidentLight(light, vec3(0)).irradiance.x, 2 * (1 - 1.0 / 16), 1e-6);
  EXPECT_EQ(incidentLight(light, {0, -3, 0}).irradiance, Rgb(0));
  EXPECT_EQ(incidentLight(light, {0, -9, 0}).irradiance, Rgb(0));
  EXPECT_EQ(incidentLight(light, light.position).irradiance, Rgb(0));  // no direction is defined
}

TEST(Punctual, DirectionalIsTheSameEverywhere) {
  PunctualLight light;
  light.kind = Kind::Directional;
  light.direction = {0, -1, 0};
  light.intensity = Rgb(5);
  for (const vec3& p : {vec3(0), vec3(1e6f, -3, 2)}) {
    EXPECT_EQ(incidentLight(light, p).irradiance, Rgb(5));
    EXPECT_EQ(incidentLight(light, p).wi, vec3(0, 1, 0));
    EXPECT_TRUE(std::isinf(incidentLight(light, p).distance));
  }
}

TEST(Punctual, SpotFadesBetweenItsCones) {
  PunctualLight light = lampAt({0, 0, 0}, Rgb(1));
  light.kind = Kind::Spot;
  light.innerCone = 0.1f;
  light.outerCone = 0.5f;
  const auto at = [&](float cosine) {  // at unit distance, off the axis -Z
    return incidentLight(light, {std::sqrt(1 - cosine * cosine), 0, -cosine}).irradiance.x;
  };
  EXPECT_NEAR(at(1), 1, 1e-6);
  EXPECT_NEAR(at(0.91f), 1, 1e-5);
  EXPECT_NEAR(at(0.7f), 0.25, 1e-5);  // half way: squared
  EXPECT_NEAR(at(0.6f), 0.0625, 1e-5);
  EXPECT_EQ(at(0.49f), 0);
  EXPECT_EQ(at(-1), 0);
  light.innerCone = light.outerCone;  // a sharp edge
  EXPECT_EQ(at(0.499f), 0);
  EXPECT_NEAR(at(0.501f), 1, 1e-5);
}

// The flux of a spot of 1 W, and its intensity on the axis, however narrow its cones are. Over
// rings of the angle a from the axis: 2 pi sin a da.
TEST(Punctual, NarrowSpotsHaveTheirPower) {
  for (const auto& [inner, outer] : {std::pair(0.0, 30.0),
                                     {0.0, 2.0},
                                     {0.0, 0.1},
                                     {1.0, 1.0},
                                     {0.5, 0.51},
                                     {0.0, 0.01},
                                     {30.0, 30.0},
                                     {89.0, 90.0}}) {
    PunctualLight light = lampAt({0, 0, 0}, Rgb(1));
    light.kind = Kind::Spot;
    light.innerCone = coneOf(glm::radians(inner)), light.outerCone = coneOf(glm::radians(outer));
    light.intensity = Rgb(light.intensityOfOneWatt());
    const auto at = [&](double angle) {
      return double(
          incidentLight(light, {float(std::sin(angle)), 0, -float(std::cos(angle))}).irradiance.x);
    };
    EXPECT_FLOAT_EQ(float(at(0)), light.intensity.x);
    constexpr int kRings = 20000;
    const double step = glm::radians(outer) * 1.1 / kRings;
    double flux = 0;
    for (int i = 0; i < kRings; ++i)
      flux += at((i + 0.5) * step) * 2 * kPiD * std::sin((i + 0.5) * step) * step;
    EXPECT_NEAR(flux, 1, 2e-3) << inner << " " << outer;
  }
}

// A Lambertian plane y = 0.
Scene plane(float albedo = 0.5f) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(albedo))), {-10, 0, 10}, {20, 0, 0}, {0, 0, -20});
  return scene;
}
// A view of 8 m x 8 m from above.
Camera above() {
  Camera camera = topCamera(50, 10);
  camera.orthographic = true;
  camera.halfHeight = 4;
  return camera;
}
Image renderFromAbove(const Scene& scene, int samples = 4, uint64_t seed = 0, int size = 33) {
  const Probe black(Image(2, 1, 3));
  return renderScene(scene, above(), black, "importance", smallRender(size, size, samples, 1, seed))
      .film.mean();
}

// L = albedo / pi x I cos / d^2 = albedo / pi x I h / d^3.
TEST(Punctual, PlaneUnderALampFollowsTheCosineAndInverseSquareLaws) {
  Scene scene = plane();
  scene.lights.push_back(lampAt({1, 2, 0}, Rgb(8, 4, 2)));
  const int n = 33;
  const Image image = renderFromAbove(scene, 4, 0, n);
  for (int y = 0; y < n; y += 4)
    for (int x = 0; x < n; x += 4) {
      const double px = 8 * (x + 0.5) / n - 4, pz = 8 * (y + 0.5) / n - 4;
      const double d = std::sqrt((px - 1) * (px - 1) + 4 + pz * pz);
      const double expected = 0.5 / kPiD * 8 * 2 / (d * d * d);
      EXPECT_NEAR(image.rgb(x, y).x / expected, 1, 0.01) << px << " " << pz;
      EXPECT_NEAR(image.rgb(x, y).y, image.rgb(x, y).x / 2, 1e-6);
    }
}

TEST(Punctual, OnlyOccludersBetweenLightAndSurfaceCastShadows) {
  for (const float height : {1.0f, 3.0f}) {
    Scene scene = plane();
    scene.lights.push_back(lampAt({0, 2, 0}, Rgb(1)));
    addQuad(scene, 0, {-0.5f, height, 0.5f}, {1, 0, 0}, {0, 0, -1});
    // A point beside the occluder, which hides the centre from the camera; its shadow extends to
    // x = 1.
    const Rgb beside = renderFromAbove(scene).rgb(33 * 4.75 / 8, 16);
    EXPECT_EQ(beside.x > 0, height > 2);
  }
}

TEST(Punctual, DirectionalLightAddsToTheProbe) {
  Scene scene = plane();
  PunctualLight sun;
  sun.kind = Kind::Directional;
  sun.direction = glm::normalize(vec3(1, -1, 0));
  sun.intensity = Rgb(2);
  scene.lights.push_back(sun);
  const Probe probe(constantProbe({16, 8}, Rgb(0.25f)));
  const Image image =
      renderScene(scene, above(), probe, "importance", smallRender(8, 8, 1024, 1)).film.mean();
  EXPECT_NEAR(meanColor(image).x, 0.5 * 0.25 + 0.5 / kPiD * 2 * std::sqrt(0.5), 2e-4);
}

// With more lights than are evaluated at every point, the sampled ones are an unbiased estimate.
TEST(Punctual, SampledLightsAreUnbiased) {
  Scene scene = plane();
  double expected = 0;  // at the centre
  for (int i = 0; i < 3 * PunctualLights::kFirst; ++i) {
    const vec3 p(std::sin(float(i)) * 3, 1 + float(i % 5), std::cos(2.0f * float(i)) * 3);
    const float intensity = 1 + float(i % 7);
    scene.lights.push_back(lampAt(p, Rgb(intensity)));
    expected += 0.5 / kPiD * intensity * p.y / std::pow(glm::length(p), 3);
  }
  Camera narrow = above();
  narrow.halfHeight = 1e-3f;
  std::vector<double> means;
  for (uint64_t seed = 0; seed < 32; ++seed) {
    const Probe black(Image(2, 1, 3));
    means.push_back(
        meanColor(renderScene(scene, narrow, black, "importance", smallRender(4, 4, 16, 1, seed))
                      .film.mean())
            .x);
  }
  const Moments m = Moments::of(means);
  EXPECT_GT(tTest(m, expected), 1e-5);
  EXPECT_LT(std::sqrt(m.variance), 0.05 * expected);
}

// In a composite, lights contribute to L_obj and to L_noobj: L_noobj of the ground equals the
// closed form, also at shadows of objects, and L_obj equals a render of the whole scene.
TEST(Punctual, LightBothScenesOfAComposite) {
  Scene scene = plane();
  scene.lights.push_back(lampAt({1, 2, 0}, Rgb(8)));
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.9f))), {-1, 0.5f, 0.5f}, {1, 0, 0}, {0, 0, -1});
  const ObjectMask isObject{false, true};
  const Probe black(Image(2, 1, 3));
  const World world(scene, rayMasks(isObject), allTables());
  constexpr int kSize = 33;
  const RenderSettings settings = smallRender(kSize, kSize, 16, 1);
  const auto lighting = makeStrategy("importance", black, settings.mis, "test");
  const std::atomic<bool> stop = false;
  for (const Passes passes : {Passes::One, Passes::Two}) {
    const CompositeRender r = renderComposite(
        world, above(), *lighting, Image(kSize, kSize, 3), settings, passes, true, [](double) {},
        stop);
    const Image with = compositeLayer(r.film(), CompositeLayer::WithObjects);
    const Image without = compositeLayer(r.film(), CompositeLayer::WithoutObjects);
    const Image whole = renderFromAbove(scene, 64, 1, kSize);
    int shadowed = 0;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const double px = 8 * (x + 0.5) / kSize - 4, pz = 8 * (y + 0.5) / kSize - 4;
        const double d = std::sqrt((px - 1) * (px - 1) + 4 + pz * pz);
        const double expected = 0.5 / kPiD * 8 * 2 / (d * d * d);
        EXPECT_NEAR(without.rgb(x, y).x / expected, 1, 0.03) << px << " " << pz;
        shadowed += with.rgb(x, y).x < 0.1 * expected;
      }
    EXPECT_GT(shadowed, 5);
    EXPECT_NEAR(meanColor(with).x / meanColor(whole).x, 1, 0.02);
  }
}

TEST(GltfLights, AreTransformedByTheirNodes) {
  GltfWriter w;
  addTriangle(w);
  w.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"},
       {"intensity", 3},
       {"color", {1, 0.5, 0}},
       {"range", 7},
       {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}},
      {{"type", "directional"}},
      {{"type", "point"}, {"intensity", 0}}};
  const float s = std::sqrt(0.5f);  // a quarter turn about X takes -Z to +Y
  for (int light : {0, 1, 2}) {
    json node = {{"translation", {1, 2, 3}}, {"rotation", {s, 0, 0, s}}, {"scale", {4, 4, 4}}};
    node["extensions"]["KHR_lights_punctual"]["light"] = light;
    w.add("nodes", node);
  }
  const std::vector<PunctualLight> lights = w.load().lights;
  ASSERT_EQ(lights.size(), 2u);  // the black one is dropped
  EXPECT_EQ(lights[0].kind, Kind::Spot);
  EXPECT_EQ(lights[0].position, vec3(1, 2, 3));
  EXPECT_NEAR(glm::distance(lights[0].direction, vec3(0, 1, 0)), 0, 1e-6);
  EXPECT_NEAR(glm::distance(683.0f * lights[0].intensity, Rgb(3, 1.5f, 0)), 0, 1e-5);
  EXPECT_EQ(lights[0].range, 7);
  EXPECT_NEAR(w.load({glm::mat3(2), {}}).lights[0].range, 14, 1e-5) << "a change of the unit";
  EXPECT_NEAR(lights[0].innerCone, 1 - std::cos(0.1), 1e-8);
  EXPECT_NEAR(lights[0].outerCone, 1 - std::cos(0.2), 1e-8);
  EXPECT_EQ(lights[1].kind, Kind::Directional);
  EXPECT_NEAR(683 * lights[1].intensity.x, 1, 1e-6);
  EXPECT_TRUE(w.warnings.empty());
  GltfChoice radiometric;
  radiometric.lightUnits = LightUnits::Radiometric;
  EXPECT_EQ(loadGltf(w.save(), {}, nullptr, radiometric).lights[0].intensity, Rgb(3, 1.5f, 0));
}

TEST(GltfLights, InvalidLightsAreRejected) {
  const auto errorMessage = [](const json& light, int index = 0) {
    GltfWriter w;
    addTriangle(w);
    w.root["extensions"]["KHR_lights_punctual"]["lights"] = {light};
    w.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = index;
    return w.errorMessage();
  };
  const auto holds = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_EQ(errorMessage({{"type", "point"}}), "");
  EXPECT_TRUE(holds(errorMessage({{"type", "point"}}, 1), "lights[1] does not exist"));
  EXPECT_TRUE(
      holds(errorMessage({{"type", "area"}}), "\"area\" is not directional, point or spot"));
  EXPECT_TRUE(
      holds(errorMessage({{"type", "point"}, {"intensity", -1}}), "lights[0].intensity: -1"));
  EXPECT_TRUE(holds(errorMessage({{"type", "point"}, {"range", 0}}), "lights[0].range"));
  EXPECT_TRUE(holds(errorMessage({{"type", "point"}, {"color", {1, -1, 0}}}), "lights[0].color"));
  EXPECT_TRUE(holds(errorMessage({{"type", "spot"}, {"spot", {{"outerConeAngle", 2}}}}),
                    "outerConeAngle: 2 is not in the range"));
  EXPECT_TRUE(holds(errorMessage({{"type", "spot"},
                                  {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.4}}}}),
                    "innerConeAngle"));
}

// A triangle in front of the camera, lit by a directional light of 683 lx.
std::string litTriangle(GltfWriter& w) {
  addTriangle(w);
  w.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "directional"}, {"intensity", 683}}};
  w.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  return w.save();
}

TEST(SlowGltfLights, OptionsScaleThemAndSetTheirUnits) {
  GltfWriter w;
  const std::string model = litTriangle(w);
  const TemporaryFolder folder;
  const auto mean = [&](const std::vector<std::string>& options) {
    std::vector<std::string> all = {
        "render", model,       "-o", folder / "a.pfm", "--size",
        "8x8",    "--samples", "2",  "--probe",        folder / "black.pfm"};
    all.insert(all.end(), options.begin(), options.end());
    const CommandResult r = runCommand(all);
    EXPECT_EQ(r.status, 0) << r.error;
    return meanColor(readImage(folder / "a.pfm")).x;
  };
  writeImage(folder / "black.pfm", Image(2, 1, 3));
  const float whole = mean({});
  EXPECT_GT(whole, 0);
  EXPECT_NEAR(mean({"--lights", "0.25"}) / whole, 0.25, 1e-5);
  EXPECT_EQ(mean({"--lights", "off"}), 0);
  EXPECT_EQ(mean({"--lights", "0"}), 0);
  EXPECT_NEAR(mean({"--light-units", "radiometric"}) / whole, 683, 0.01);
  EXPECT_NEAR(mean({"--light-units", "photometric"}) / whole, 1, 1e-6);
  const auto expectOptionError = [&](const std::vector<std::string>& options,
                                     const std::string& reason) {
    std::vector<std::string> all = {"render", model, "-o", folder / "a.pfm"};
    all.insert(all.end(), options.begin(), options.end());
    expectError(all, reason);
  };
  expectOptionError({"--lights", "-1"}, "--lights: `-1` is not \"off\" or a factor, 0 or more");
  expectOptionError({"--lights", "on"}, "--lights");
  expectOptionError({"--light-units", "lux"}, "--light-units: `lux` is not known");
}

TEST(GltfLights, ClippedImagesAreReported) {
  GltfWriter w;
  const std::string model = litTriangle(w);
  const TemporaryFolder folder;
  writeImage(folder / "white.pfm", constantProbe({4, 2}, Rgb(40)));
  const std::vector<std::string> command = {"render", model, "--probe",   folder / "white.pfm",
                                            "--size", "8x8", "--samples", "2"};
  const auto errorOf = [&](const std::vector<std::string>& options) {
    std::vector<std::string> all = command;
    all.insert(all.end(), options.begin(), options.end());
    return runCommand(all).error;
  };
  const std::string clipped = errorOf({"-o", folder / "a.png", "--exposure", "0"});
  EXPECT_NE(clipped.find(
                "are clipped; try --exposure -6, or dim the model's lights with --lights FACTOR"),
            std::string::npos)
      << clipped;
  EXPECT_EQ(errorOf({"-o", folder / "a.png", "--exposure", "-6"}).find("clipped"),
            std::string::npos);
  EXPECT_EQ(errorOf({"-o", folder / "a.exr"}).find("clipped"), std::string::npos);
}

// Punctual lights do not light surfaces through refractive bodies: one warning if the scene has
// both. Thin sheets give no warning.
TEST(GltfLights, BlockingByRefractiveBodiesIsReported) {
  for (const bool volume : {false, true}) {
    GltfWriter w;
    addTriangle(w, {{"material", 0}});
    json extensions = {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}};
    if (volume) extensions["KHR_materials_volume"] = {{"thicknessFactor", 1}};
    w.add("materials",
          {{"pbrMetallicRoughness", {{"roughnessFactor", 0}}}, {"extensions", extensions}});
    w.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    w.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    const TemporaryFolder folder;
    const CommandResult r =
        runCommand({"render", w.save(), "-o", folder / "a.pfm", "--size", "8x8", "--samples", "2"});
    EXPECT_EQ(r.status, 0) << r.error;
    EXPECT_EQ(r.error.find("do not pass smooth bodies") != std::string::npos, volume) << r.error;
    const CommandResult straight =
        runCommand({"render", w.save(), "-o", folder / "a.pfm", "--size", "8x8", "--samples", "2",
                    "--glass-shadows", "straight"});
    EXPECT_EQ(straight.error.find("do not pass"), std::string::npos) << straight.error;
    w.root["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 0.5;
    const CommandResult rough =
        runCommand({"render", w.save(), "-o", folder / "a.pfm", "--size", "8x8", "--samples", "2"});
    EXPECT_EQ(rough.error.find("do not pass"), std::string::npos) << rough.error;
  }
}

TEST(GltfLights, LightASceneWithoutAProbe) {
  GltfWriter w;
  addTriangle(w);
  const TemporaryFolder folder;
  expectError({"render", w.save(), "-o", folder / "a.pfm"}, "nothing lights the scene");
  w.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}}};
  w.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  const CommandResult result =
      runCommand({"render", w.save(), "-o", folder / "a.pfm", "--size", "8x8", "--samples", "2"});
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_NE(result.error.find("no probe; lit by the model's 1 light"), std::string::npos);
}

}  // namespace
}  // namespace chromeball::punctual_test
