// SPDX-License-Identifier: Apache-2.0
// Single-sided surfaces: visibility of their backs to camera and mirrors, and their shadows.
#include <gtest/gtest.h>

#include <fstream>

#include "gltf_writer.h"
#include "probe/synth.h"
#include "run_command.h"
#include "test_scene.h"

namespace chromeball::single_sided_test {
namespace {

using nlohmann::json;

constexpr SingleSided kModes[] = {SingleSided::Camera, SingleSided::Light, SingleSided::Off};

Probe whiteProbe() { return Probe(constantProbe({64, 32}, Rgb(1))); }

Material oneSided(Rgb albedo, SingleSided mode) {
  Material m = lambert(albedo);
  m.doubleSided = false;
  m.singleSided = mode;
  return m;
}

// A horizontal quad of 400 m x 400 m whose front faces up or down.
void addRoof(Scene& scene, const Material& material, float height, bool frontUp) {
  const vec3 a(400, 0, 0), b(0, 0, -400), corner(-200, height, 200);
  addQuad(scene, addMaterial(scene, material), corner, frontUp ? a : b, frontUp ? b : a);
}

// Mean green channel of a small render.
float greenMean(const Scene& scene, const Camera& camera,
                const std::string& strategy = "importance", Mis mis = Mis::Balance,
                const Probe& probe = whiteProbe(), int samples = 1024) {
  RenderSettings settings = smallRender(4, 4, samples, 4);
  settings.mis = mis;
  return meanColor(renderScene(scene, camera, probe, strategy, settings).film.mean()).y;
}

TEST(SingleSided, TheCameraSeesThroughBacksUnlessItIsOff) {
  for (const SingleSided mode : kModes)
    for (const bool frontUp : {true, false}) {
      Scene scene;
      addRoof(scene, oneSided(Rgb(0.5f), mode), 0, frontUp);
      const bool seen = frontUp || mode == SingleSided::Off;
      EXPECT_NEAR(greenMean(scene, topCamera(4, 20)), seen ? 0.5f : 1, 0.01f)
          << int(mode) << frontUp;
    }
}

// A mirror below an unlit roof of radiance 1/2 reflects the roof, or the probe of radiance 1 if the
// roof's back is invisible.
TEST(SingleSided, MirrorsSeeThroughBacksUnlessItIsOff) {
  Material mirror;
  mirror.roughness = 0;
  mirror.doubleSided = true;
  for (const SingleSided mode : kModes)
    for (const bool frontUp : {true, false}) {
      Scene scene;
      addQuad(scene, addMaterial(scene, mirror), {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
      Material roof = oneSided(Rgb(0.5f), mode);
      roof.unlit = true;
      addRoof(scene, roof, 3, frontUp);
      const Camera camera = Camera::lookAt({0, 1, 2}, {0, 0, 0}, {0, 1, 0}, 0.1f);
      const bool seen = !frontUp || mode == SingleSided::Off;
      EXPECT_NEAR(greenMean(scene, camera, "importance", Mis::Balance, whiteProbe(), 16),
                  seen ? 0.5f : 1, 0.01f)
          << int(mode) << frontUp;
    }
}

// A floor of albedo 1/2 under a roof that covers the sky. If light passes through the roof's back,
// the floor receives the probe's light and the light that the roof reflects from below; its
// exitant radiance is 1/2 (1 + albedo).
TEST(SingleSided, LightPassesBacksInModeLight) {
  for (const SingleSided mode : kModes)
    for (const bool frontUp : {true, false})
      for (const float albedo : {0.0f, 0.5f}) {
        Scene scene;
        addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {-.1f, 0, .1f}, {.2f, 0, 0},
                {0, 0, -.2f});
        addRoof(scene, oneSided(Rgb(albedo), mode), 1, frontUp);
        const Camera camera = Camera::lookAt({0, 0.5f, 0}, {0, 0, 0}, {0, 0, -1}, 0.1f);
        const bool passes = mode == SingleSided::Light && !frontUp;
        // Otherwise the floor receives only the light that the roof reflects: 1/2 albedo.
        const float expected = 0.5f * (passes ? 1 + albedo : albedo);
        for (const char* strategy : {"importance", "bsdf"})
          for (const Mis mis : {Mis::Off, Mis::Balance, Mis::Power})
            EXPECT_NEAR(greenMean(scene, camera, strategy, mis), expected, 0.02f)
                << int(mode) << frontUp << albedo << strategy << int(mis);
      }
}

// A closed body blocks all shadow rays: light that enters it hits a front face.
TEST(SingleSided, ClosedBodiesCastShadows) {
  for (const SingleSided mode : kModes) {
    Scene scene;
    addSphere(scene, addMaterial(scene, oneSided(Rgb(0.5f), mode)), {0, 2, 0}, 1, 16);
    const Accel accel(scene);
    EXPECT_EQ(accel.transmittance({{0.1f, 0, 0.1f}, {0, 1, 0}}), Rgb(0)) << int(mode);
    // From inside the ball: light from outside hits a front face on its way in.
    EXPECT_EQ(accel.transmittance({{0.1f, 2, 0.1f}, {0, 1, 0}}), Rgb(0)) << int(mode);
    Scene room;  // the normals point inwards
    addSphere(room, addMaterial(room, oneSided(Rgb(0.5f), mode)), {0, 2, 0}, -1, 16);
    const Accel inside(room);
    EXPECT_EQ(inside.transmittance({{0.1f, 2, 0.1f}, {0, 1, 0}}),
              Rgb(mode == SingleSided::Light ? 1.0f : 0.0f));
  }
}

// The front of a mirrored instance is the transformed front, not the side to which the cross
// product of the transformed edges points (glTF 2.0, 3.7.4).
TEST(SingleSided, MirroredInstancesKeepTheirFronts) {
  Scene scene;
  addQuad(scene, addMaterial(scene, oneSided(Rgb(0.5f), SingleSided::Light)), {-1, 0, 1}, {2, 0, 0},
          {0, 0, -2});
  scene.instances[0].toWorld = Transform{glm::mat3(1), {0, 1, 0}};
  scene.instances.push_back(scene.instances[0]);  // and upside down
  scene.instances[1].toWorld = Transform{glm::mat3(1, 0, 0, 0, -1, 0, 0, 0, 1), {10, 1, 0}};
  const Accel accel(scene);
  // Instance 0 faces up: light from below hits its back and passes. Instance 1 faces down.
  EXPECT_EQ(accel.transmittance({{0.1f, 2, 0}, {0, -1, 0}}), Rgb(1));
  EXPECT_EQ(accel.transmittance({{0.1f, 0, 0}, {0, 1, 0}}), Rgb(0));
  EXPECT_EQ(accel.transmittance({{10.1f, 2, 0}, {0, -1, 0}}), Rgb(0));
  EXPECT_EQ(accel.transmittance({{10.1f, 0, 0}, {0, 1, 0}}), Rgb(1));
}

// A single-sided lamp emits from its front only, in every mode.
TEST(SingleSided, LampsEmitFromTheirFronts) {
  const Probe black(Image(2, 1, 3));
  for (const SingleSided mode : kModes)
    for (const bool frontUp : {true, false}) {
      Scene scene;
      Material lamp = oneSided(Rgb(0), mode);
      lamp.emission = Rgb(2);
      addRoof(scene, lamp, 0, frontUp);
      EXPECT_EQ(greenMean(scene, topCamera(4, 20), "importance", Mis::Balance, black, 16),
                frontUp ? 2.0f : 0.0f);
    }
}

// A closed room whose single-sided walls face inwards.
std::string roomFile(GltfWriter& w) {
  w.add("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
  const int positions = w.vec3s({-9, -5, -9, 9, -5, -9, 0, -5, 9, 0, 9, 0});
  w.add("nodes", {{"mesh", w.mesh({{"attributes", {{"POSITION", positions}}},
                                   {"indices", w.indices({0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3})},
                                   {"material", 0}})}});
  return w.save();
}

void writeProbe(const std::string& path, float radiance) {
  std::ofstream file(path, std::ios::binary);
  file << "PF\n2 1\n-1\n";
  for (int i = 0; i < 6; ++i) file.write(reinterpret_cast<const char*>(&radiance), 4);
}

// The command's messages about the model, or a scene file, under a constant probe.
std::string messagesOf(const std::string& file, float radiance,
                       const std::vector<std::string>& more = {}) {
  const TemporaryFolder folder;
  writeProbe(folder / "probe.pfm", radiance);
  std::vector<std::string> arguments = {
      "render",         file,     "--probe", folder / "probe.pfm", "-o",
      folder / "a.pfm", "--size", "96x96",   "--samples",          "4"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const CommandResult r = runCommand(arguments);
  EXPECT_EQ(r.status, 0) << r.error;
  return r.error;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(SlowSingleSided, ABlackRoomIsReported) {
  GltfWriter w;
  const TemporaryFolder folder;
  std::ofstream(folder / "a.toml") << "model = '" << roomFile(w) << "'\n"
                                   << "[camera]\nposition = [0, -2, 30]\nlook_at = [0, -2, 0]\n";
  const std::string message = messagesOf(folder / "a.toml", 1);
  EXPECT_TRUE(contains(message, "are black: single-sided walls")) << message;
  EXPECT_TRUE(contains(message, "--single-sided light")) << message;
  EXPECT_FALSE(
      contains(messagesOf(folder / "a.toml", 1, {"--single-sided", "light"}), "are black"));
  expectError({"render", folder / "a.toml", "-o", folder / "b.pfm", "--single-sided", "ligth"},
              "--single-sided: `ligth` is not known; did you mean `light`?");
}

// Walls are named only where they are the cause.
TEST(SlowSingleSided, WallsAreNotBlamedForABlackProbeOrAShadowedSide) {
  GltfWriter w;
  const TemporaryFolder folder;
  const std::string model = roomFile(w);
  std::ofstream(folder / "a.toml") << "model = '" << model << "'\n"
                                   << "[camera]\nposition = [0, -2, 30]\nlook_at = [0, -2, 0]\n";
  const std::string unlit = messagesOf(folder / "a.toml", 0);
  EXPECT_TRUE(contains(unlit, "the probe is black")) << unlit;
  EXPECT_FALSE(contains(unlit, "walls")) << unlit;

  // A closed body that turns its front faces outwards, lit from behind.
  GltfWriter outwards;
  outwards.add("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
  const int positions = outwards.vec3s({-9, -5, 0, 9, -5, 0, 0, 9, 0, 0, 0, -3});
  outwards.add(
      "nodes",
      {{"mesh", outwards.mesh({{"attributes", {{"POSITION", positions}}},
                               {"indices", outwards.indices({0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0})},
                               {"material", 0}})}});
  std::ofstream(folder / "b.toml") << "model = '" << outwards.save() << "'\n"
                                   << "[camera]\nposition = [0, 0, 30]\nlook_at = [0, 0, 0]\n"
                                   << "[[light]]\ntype = \"sun\"\ndirection = [0, 0, -1]\n"
                                   << "irradiance = [1, 1, 1]\n";
  const std::string shadowed = messagesOf(folder / "b.toml", 0);
  EXPECT_TRUE(contains(shadowed, "no light reaches them")) << shadowed;
  EXPECT_FALSE(contains(shadowed, "walls")) << shadowed;
}

TEST(SlowSingleSided, AnEmptyViewIsReported) {
  GltfWriter w;  // a triangle that faces down
  w.add("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
  const int positions = w.vec3s({-1, 0, -1, 1, 0, -1, 0, 0, 1});
  w.add("nodes", {{"mesh", w.mesh({{"attributes", {{"POSITION", positions}}},
                                   {"indices", w.indices({0, 1, 2})},
                                   {"material", 0}})}});
  const std::string model = w.save();
  const std::string message = messagesOf(model, 1, {"--view", "0,60"});
  EXPECT_TRUE(contains(message, "no surface is in view")) << message;
  EXPECT_TRUE(contains(message, "--single-sided off")) << message;
  EXPECT_FALSE(
      contains(messagesOf(model, 1, {"--view", "0,60", "--single-sided", "off"}), "in view"));
  EXPECT_FALSE(contains(messagesOf(model, 1), "in view"));  // its own view is from below
}

// The camera is not blamed if no camera would see anything.
TEST(SlowSingleSided, SurfacesThatNeverShowAreReported) {
  const auto message = [](const json& material, const std::vector<float>& positions) {
    GltfWriter w;
    w.add("materials", material);
    w.add(
        "nodes",
        {{"mesh", w.mesh({{"attributes", {{"POSITION", w.vec3s(positions)}}}, {"material", 0}})}});
    return messagesOf(w.save(), 1);
  };
  const std::vector<float> triangle = {-1, 0, 0, 1, 0, 0, 0, 1, 0},
                           line = {-1, 0, 0, 1, 0, 0, 0, 0, 0};
  const json clear = {{"baseColorFactor", {1, 1, 1, 0}}};
  for (const json& material :
       std::vector<json>{{{"alphaMode", "MASK"}, {"alphaCutoff", 2}},
                         {{"alphaMode", "MASK"}, {"pbrMetallicRoughness", clear}},
                         {{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", clear}}}) {
    const std::string hidden = message(material, triangle);
    EXPECT_TRUE(contains(hidden, "all have an alpha of 0")) << hidden;
    EXPECT_FALSE(contains(hidden, "another camera")) << hidden;
  }
  const std::string flat = message(json::object(), line);
  EXPECT_TRUE(contains(flat, "all triangles have no area")) << flat;
  EXPECT_FALSE(contains(flat, "another camera")) << flat;
}

}  // namespace
}  // namespace chromeball::single_sided_test
