// SPDX-License-Identifier: Apache-2.0
// The [[light]] tables of a scene file.
#include "scene/builder/scene_builder.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "front/scene_file.h"
#include "lighting/scene_sources.h"
#include "probe/synth.h"
#include "run_command.h"
#include "small_model.h"
#include "test_scene.h"

namespace chromeball::lamp_test {
namespace {

SceneFile read(const TemporaryFolder& folder, const std::string& toml) {
  writeSmallModel(folder / "model.gltf");
  std::ofstream(folder / "a.toml") << "model = 'model.gltf'\n" << toml;
  return readSceneFile(folder / "a.toml");
}
Lamp lampOf(const std::string& keys) {
  const TemporaryFolder folder;
  return read(folder, "[[light]]\n" + keys).lamps.at(0);
}

// Exitant radiance at the centre of a grey floor of 20 m x 20 m, seen from above the lamp.
Rgb floorRadiance(const Lamp& lamp, const std::string& strategy = "importance",
                  Mis mis = Mis::Balance) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {-10, 0, 10}, {20, 0, 0}, {0, 0, -20});
  addLamp(scene, lamp, glm::dvec3(0));
  Camera camera = topCamera(0.5f, 10);
  camera.orthographic = true;
  camera.halfHeight = 0.02f;
  RenderSettings settings = smallRender(4, 4, 2048, 1);
  settings.mis = mis;
  return meanColor(
      renderScene(scene, camera, Probe(Image(2, 1, 3)), strategy, settings).film.mean());
}

// L = albedo / pi x I / h^2.
TEST(Lamps, PointsAndSpotsFollowTheInverseSquareLaw) {
  const Rgb point =
      floorRadiance(lampOf("type = 'point'\nposition = [0, 2, 0]\nintensity = [8, 4, 2]"));
  EXPECT_NEAR(point.x, 0.5 / kPiD * 8 / 4, 1e-3);
  EXPECT_NEAR(point.z, 0.5 / kPiD * 2 / 4, 1e-3);
  const Lamp spot = lampOf(
      "type = 'spot'\nposition = [0, 2, 0]\ndirection = [0, -3, 0]\nintensity = 8\n"
      "inner_angle = 20\nouter_angle = 30\nrange = 4");
  EXPECT_NEAR(spot.punctual->outerCone, 1 - std::cos(kPiD / 6), 1e-6);
  EXPECT_NEAR(spot.punctual->innerCone, 1 - std::cos(kPiD / 9), 1e-6);
  EXPECT_NEAR(floorRadiance(spot).x, 0.5 / kPiD * 8 / 4 * (1 - 1.0 / 16), 1e-3);
  const Lamp away =
      lampOf("type = 'spot'\nposition = [0, 2, 0]\ndirection = [0, 1, 0]\nintensity = 8");
  EXPECT_EQ(floorRadiance(away).x, 0);
}

// The integral over the sphere of the intensity of a 10 W lamp is 10 W.
TEST(Lamps, PowerIsTheIntegralOfTheIntensity) {
  for (const char* text :
       {"type = 'point'\nposition = [0, 0, 0]\npower = 10",
        "type = 'spot'\nposition = [0, 0, 0]\ndirection = [0, 1, 0]\npower = 10",
        "type = 'spot'\nposition = [0, 0, 0]\ndirection = [0, 1, 0]\npower = 10\n"
        "inner_angle = 40\nouter_angle = 60",
        "type = 'spot'\nposition = [0, 0, 0]\ndirection = [0, 1, 0]\npower = 10\n"
        "inner_angle = 90\nouter_angle = 90"}) {
    const Lamp lamp = lampOf(text);
    constexpr int kSteps = 200000;
    double power = 0;
    for (int i = 0; i < kSteps; ++i) {  // rings of equal solid angle about +Y
      const float z = 1 - 2 * (float(i) + 0.5f) / kSteps;
      const vec3 at(std::sqrt(1 - z * z), z, 0);
      power += incidentLight(*lamp.punctual, at).irradiance.x * 4 * kPiD / kSteps;
    }
    EXPECT_NEAR(power, 10, 0.02) << text;
  }
}

// Irradiance from a disc of radius r at distance h on its axis: E = pi L r^2 / (r^2 + h^2).
TEST(Lamps, DiscIrradianceMatchesTheClosedForm) {
  for (const float radius : {0.5f, 2.0f}) {
    const Lamp lamp = lampOf(fmt::format(
        "type = 'disc'\nposition = [0, 1, 0]\ndirection = [0, -1, 0]\nradius = {}\nradiance = 3",
        radius));
    const double r2 = double(radius) * radius, expected = 0.5 * 3 * r2 / (r2 + 1);
    for (const Mis mis : {Mis::Off, Mis::Balance, Mis::Power})
      EXPECT_NEAR(floorRadiance(lamp, "importance", mis).x / expected, 1, 0.02) << radius;
    const Lamp back = lampOf(fmt::format(
        "type = 'disc'\nposition = [0, 1, 0]\ndirection = [0, 1, 0]\nradius = {}\nradiance = 3",
        radius));
    EXPECT_EQ(floorRadiance(back).x, 0);
  }
}

// A lamp whose coordinates are 0 or small across its plane; shadow rays have the rounding errors of
// their length.
TEST(Lamps, LightEqualSurfacesWhereverTheirPlaneIs) {
  for (const int axis : {0, 1, 2})
    for (const float place : {0.0f, 0.01f, 1.0f})
      for (const float distance : {1.0f, 300.0f}) {
        vec3 along(0), u(0), v(0);
        along[axis] = 1, u[(axis + 1) % 3] = 20 * distance, v[(axis + 2) % 3] = 20 * distance;
        const Lamp lamp = lampOf(fmt::format(
            "type = 'disc'\nposition = [{}, {}, {}]\ndirection = [{}, {}, {}]\nradius = {}\n"
            "radiance = 3",
            place * along.x, place * along.y, place * along.z, along.x, along.y, along.z,
            distance));
        Scene scene;
        const vec3 middle = (place + distance) * along;
        addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), middle - 0.5f * (u + v), v, u);
        addLamp(scene, lamp, glm::dvec3(0));
        const Camera camera = Camera::lookAt(middle - 0.5f * distance * along, middle, u, 0.01f);
        RenderSettings settings = smallRender(2, 2, 1024, 1);
        settings.mis = Mis::Off;
        const Rgb seen = meanColor(
            renderScene(scene, camera, Probe(Image(2, 1, 3)), "importance", settings).film.mean());
        EXPECT_NEAR(seen.x / (0.5 * 3 * 0.5), 1, 0.02) << axis << ' ' << place << ' ' << distance;
      }
}

TEST(Lamps, DiscsHaveTheirExactAreaAndPower) {
  const Lamp lamp = lampOf(
      "type = 'disc'\nname = 'window'\nposition = [5, 6, 7]\ndirection = [1, 2, -2]\n"
      "radius = 0.25\npower = [10, 5, 0]");
  Scene scene;
  scene.nodeNames = {"floor"};
  scene.nodeParents = {-1};
  addLamp(scene, lamp, {4, 4, 4});
  EXPECT_EQ(scene.nodeNames, (std::vector<std::string>{"floor", "window"}));
  EXPECT_EQ(scene.nodeParents.size(), 2u);
  EXPECT_EQ(scene.instances[0].node, 1);
  const Mesh& mesh = scene.meshes[0];
  glm::dvec3 area(0);
  for (const Triangle& t : mesh.triangles)
    area += 0.5 * glm::cross(glm::dvec3(mesh.positions[t.y]) - glm::dvec3(mesh.positions[t.x]),
                             glm::dvec3(mesh.positions[t.z]) - glm::dvec3(mesh.positions[t.x]));
  EXPECT_NEAR(glm::length(area) / (kPiD / 16), 1, 1e-5);
  EXPECT_NEAR(glm::distance(glm::normalize(area), glm::dvec3(1, 2, -2) / 3.0), 0, 1e-5);
  EXPECT_NEAR(glm::distance(mesh.positions[0], vec3(1, 2, 3)), 0, 1e-6);
  const Rgb radiance = scene.materials[0].emission;
  EXPECT_NEAR(radiance.x * kPiD * kPiD / 16, 10, 1e-4);
  EXPECT_NEAR(radiance.y / radiance.x, 0.5, 1e-6);
  EXPECT_FALSE(scene.materials[0].doubleSided);
}

TEST(Lamps, ErrorsNameTheLineInTheFile) {
  const auto errorMessage = [](const std::string& keys) {
    try {
      lampOf(keys);
    } catch (const InputError& e) {
      const std::string message = e.what();
      return message.substr(message.find("a.toml"));
    }
    return std::string();
  };
  const std::string point = "type = 'point'\nposition = [0, 2, 0]\n";
  const std::string disc = "type = 'disc'\nposition = [0, 2, 0]\nradius = 1\n";
  EXPECT_EQ(errorMessage(point + "intensity = 1"), "");
  EXPECT_EQ(
      errorMessage("position = [0, 2, 0]"),
      "a.toml:3: a sun light has no `position`; it has type, name, direction, angle, radiance, "
      "irradiance, visible");
  EXPECT_EQ(errorMessage("type = 'disk'"),
            "a.toml:3: `type`: `disk` is not known; did you mean `disc`?");
  EXPECT_EQ(errorMessage(point + "intensty = 1"),
            "a.toml:5: unknown key `intensty` in [[light]]; did you mean `intensity`?");
  EXPECT_EQ(errorMessage(point + "intensity = 1\nradius = 1"),
            "a.toml:6: a point light has no `radius`; it has type, name, position, intensity, "
            "power, range");
  EXPECT_EQ(errorMessage(point), "a.toml:2: [[light]] has neither `intensity` nor `power`");
  EXPECT_EQ(errorMessage(point + "intensity = 1\npower = 1"),
            "a.toml:6: [[light]] has `intensity`; it cannot have `power` too");
  EXPECT_EQ(errorMessage(point + "intensity = [1, -1, 0]"),
            "a.toml:5: `intensity` must be a finite number, 0 or more (W/sr), not -1");
  EXPECT_EQ(errorMessage("type = 'point'\nintensity = 1"), "a.toml:2: [[light]] has no `position`");
  EXPECT_EQ(errorMessage(disc + "radiance = 1"), "a.toml:2: [[light]] has no `direction`");
  EXPECT_EQ(errorMessage(disc + "radiance = 1\ndirection = [0, 0, 0]"),
            "a.toml:7: `direction` must not be 0, 0, 0");
  EXPECT_EQ(
      errorMessage("type = 'spot'\nposition = [0, 0, 0]\ndirection = [0, 1, 0]\nintensity = 1\n"
                   "outer_angle = 20\ninner_angle = 30"),
      "a.toml:8: `inner_angle` must be a number from 0 to 20 (degrees), not 30");
}

TEST(Lamps, LightASceneThatHasNoProbe) {
  for (const char* lamp : {"type = 'point'\nintensity = 5",
                           "type = 'disc'\ndirection = [0, 0, -1]\nradius = 1\npower = 50"}) {
    const TemporaryFolder folder;
    read(folder, fmt::format("[[light]]\nposition = [0.3, 0.3, 2]\n{}\n[render]\n"
                             "single_sided = 'off'\n",
                             lamp));
    const CommandResult r = runCommand(
        {"render", folder / "a.toml", "-o", folder / "a.pfm", "--size", "8x8", "--samples", "16"});
    EXPECT_EQ(r.status, 0) << r.error;
    EXPECT_EQ(r.error.find("black"), std::string::npos) << r.error;
  }
}

}  // namespace
}  // namespace chromeball::lamp_test
