// SPDX-License-Identifier: Apache-2.0
// Single-sided surfaces: who sees them from behind, and which light they stop.
#include <gtest/gtest.h>

#include "gltf_writer.h"
#include "probe/synth.h"
#include "run_command.h"
#include "test_scene.h"

namespace chromeball {
namespace {

constexpr SingleSided kAll[] = {SingleSided::Camera, SingleSided::Light, SingleSided::Off};

Probe whiteProbe() { return Probe(constantProbe({64, 32}, Rgb(1))); }

Material oneSided(Rgb albedo, SingleSided what) {
  Material m = lambert(albedo);
  m.doubleSided = false;
  m.singleSided = what;
  return m;
}

// 400 m wide at a height, its front up or down.
void addRoof(Scene& scene, const Material& material, float height, bool frontUp) {
  const vec3 a(400, 0, 0), b(0, 0, -400), corner(-200, height, 200);
  addQuad(scene, addMaterial(scene, material), corner, frontUp ? a : b, frontUp ? b : a);
}

float grey(const Scene& scene, const Camera& camera, const std::string& strategy = "importance",
           Mis mis = Mis::Balance, const Probe& probe = whiteProbe(), int samples = 1024) {
  RenderSettings settings = smallRender(4, 4, samples, 4);
  settings.mis = mis;
  return meanColor(renderScene(scene, camera, probe, strategy, settings).film.mean()).y;
}

TEST(SingleSided, TheCameraSeesThroughBacksUnlessItIsOff) {
  for (const SingleSided what : kAll)
    for (const bool frontUp : {true, false}) {
      Scene scene;
      addRoof(scene, oneSided(Rgb(0.5f), what), 0, frontUp);
      const bool seen = frontUp || what == SingleSided::Off;
      EXPECT_NEAR(grey(scene, topCamera(4, 20)), seen ? 0.5f : 1, 0.01f) << int(what) << frontUp;
    }
}

// Below a grey roof that shines by itself a mirror shows it, or the sky where its back is hidden.
TEST(SingleSided, MirrorsSeeThroughBacksUnlessItIsOff) {
  Material mirror;
  mirror.roughness = 0;
  mirror.doubleSided = true;
  for (const SingleSided what : kAll)
    for (const bool frontUp : {true, false}) {
      Scene scene;
      addQuad(scene, addMaterial(scene, mirror), {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
      Material roof = oneSided(Rgb(0.5f), what);
      roof.unlit = true;
      addRoof(scene, roof, 3, frontUp);
      const Camera camera = Camera::lookAt({0, 1, 2}, {0, 0, 0}, {0, 1, 0}, 0.1f);
      const bool seen = !frontUp || what == SingleSided::Off;
      EXPECT_NEAR(grey(scene, camera, "importance", Mis::Balance, whiteProbe(), 16),
                  seen ? 0.5f : 1, 0.01f)
          << int(what) << frontUp;
    }
}

// A floor of albedo 1/2 under a roof that is as wide as the sky. Where light passes its back, the
// floor has the sky's and what the roof reflects of the light from below: 1/2 (1 + albedo).
TEST(SingleSided, LightPassesBacksWhereItIsAskedTo) {
  for (const SingleSided what : kAll)
    for (const bool frontUp : {true, false})
      for (const float albedo : {0.0f, 0.5f}) {
        Scene scene;
        addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {-.1f, 0, .1f}, {.2f, 0, 0},
                {0, 0, -.2f});
        addRoof(scene, oneSided(Rgb(albedo), what), 1, frontUp);
        const Camera camera = Camera::lookAt({0, 0.5f, 0}, {0, 0, 0}, {0, 0, -1}, 0.1f);
        const bool passes = what == SingleSided::Light && !frontUp;
        // A roof in the way shows the floor its underside.
        const float expected = 0.5f * (passes ? 1 + albedo : albedo);
        for (const char* strategy : {"importance", "bsdf"})
          for (const Mis mis : {Mis::Off, Mis::Balance, Mis::Power})
            EXPECT_NEAR(grey(scene, camera, strategy, mis), expected, 0.02f)
                << int(what) << frontUp << albedo << strategy << int(mis);
      }
}

// Whatever is closed keeps the light out: it meets a front on its way in.
TEST(SingleSided, ClosedThingsCastTheirShadows) {
  for (const SingleSided what : kAll) {
    Scene scene;
    addSphere(scene, addMaterial(scene, oneSided(Rgb(0.5f), what)), {0, 2, 0}, 1, 16);
    const Accel accel(scene);
    EXPECT_EQ(accel.transmittance({{0.1f, 0, 0.1f}, {0, 1, 0}}), Rgb(0)) << int(what);
    // Out of the ball, light from outside passes no back.
    EXPECT_EQ(accel.transmittance({{0.1f, 2, 0.1f}, {0, 1, 0}}), Rgb(0)) << int(what);
    Scene room;  // turned inside out
    addSphere(room, addMaterial(room, oneSided(Rgb(0.5f), what)), {0, 2, 0}, -1, 16);
    const Accel inside(room);
    EXPECT_EQ(inside.transmittance({{0.1f, 2, 0.1f}, {0, 1, 0}}),
              Rgb(what == SingleSided::Light ? 1.0f : 0.0f));
  }
}

// A mirrored instance has its front where the file says, not where the cross product points.
TEST(SingleSided, MirroredInstancesKnowTheirFronts) {
  Scene scene;
  addQuad(scene, addMaterial(scene, oneSided(Rgb(0.5f), SingleSided::Light)), {-1, 0, 1}, {2, 0, 0},
          {0, 0, -2});
  scene.instances[0].toWorld = Transform{glm::mat3(1), {0, 1, 0}};
  scene.instances.push_back(scene.instances[0]);  // and upside down
  scene.instances[1].toWorld = Transform{glm::mat3(1, 0, 0, 0, -1, 0, 0, 0, 1), {10, 1, 0}};
  const Accel accel(scene);
  // Towards a light below, a ray meets the front of the first.
  EXPECT_EQ(accel.transmittance({{0.1f, 2, 0}, {0, -1, 0}}), Rgb(1));
  EXPECT_EQ(accel.transmittance({{0.1f, 0, 0}, {0, 1, 0}}), Rgb(0));
  EXPECT_EQ(accel.transmittance({{10.1f, 2, 0}, {0, -1, 0}}), Rgb(0));
  EXPECT_EQ(accel.transmittance({{10.1f, 0, 0}, {0, 1, 0}}), Rgb(1));
}

// A lamp shines from its front alone, whatever single-sided surfaces are taken for.
TEST(SingleSided, LampsShineFromTheirFronts) {
  const Probe black(Image(2, 1, 3));
  for (const SingleSided what : kAll)
    for (const bool frontUp : {true, false}) {
      Scene scene;
      Material lamp = oneSided(Rgb(0), what);
      lamp.emission = Rgb(2);
      addRoof(scene, lamp, 0, frontUp);
      EXPECT_EQ(grey(scene, topCamera(4, 20), "importance", Mis::Balance, black, 16),
                frontUp ? 2.0f : 0.0f);
    }
}

// A closed room, its walls single-sided and seen from inside.
std::string roomFile(GltfWriter& w) {
  w.add("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
  const int positions = w.vec3s({-9, -5, -9, 9, -5, -9, 0, -5, 9, 0, 9, 0});
  w.add("nodes", {{"mesh", w.mesh({{"attributes", {{"POSITION", positions}}},
                                   {"indices", w.indices({0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3})},
                                   {"material", 0}})}});
  return w.save();
}

TEST(SlowSingleSided, ABlackRoomIsSaidToBeOne) {
  GltfWriter w;
  const TemporaryFolder folder;
  std::ofstream(folder / "a.toml") << "model = '" << roomFile(w) << "'\n"
                                   << "[camera]\nposition = [0, -2, 30]\nlook_at = [0, -2, 0]\n";
  std::ofstream(folder / "probe.pfm") << "PF\n2 1\n-1\n"
                                      << std::string("\0\0\x80?\0\0\x80?\0\0\x80?", 12)
                                      << std::string("\0\0\x80?\0\0\x80?\0\0\x80?", 12);
  const auto render = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {
        "render",         folder / "a.toml", "--probe", folder / "probe.pfm", "-o",
        folder / "a.pfm", "--size",          "96x96",   "--samples",          "4"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult r = runCommand(arguments);
    EXPECT_EQ(r.status, 0) << r.error;
    return r.error;
  };
  const std::string asIs = render({});
  EXPECT_NE(asIs.find("are black: single-sided walls"), std::string::npos) << asIs;
  EXPECT_NE(asIs.find("--single-sided light"), std::string::npos) << asIs;
  EXPECT_EQ(render({"--single-sided", "light"}).find("are black"), std::string::npos);
  expectRefused({"render", folder / "a.toml", "-o", folder / "b.pfm", "--single-sided", "ligth"},
                "--single-sided: `ligth` is not known; did you mean `light`?");
}

}  // namespace
}  // namespace chromeball
