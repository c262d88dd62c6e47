// SPDX-License-Identifier: Apache-2.0
// The keys between which models, lamps and cameras move, and the warnings where they do not follow
// the motion.
#include <gtest/gtest.h>

#include "base/error.h"
#include "front/plan_render.h"
#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "probe/synth.h"
#include "run_command.h"
#include "session/render_loaded.h"
#include "temporary_folder.h"
#include "test_probes.h"

namespace chromeball::motion_keys_test {
namespace {

using nlohmann::json;

// A model with an animation of one second.
class Animated : public GltfWriter {
 public:
  Animated() {
    times_ = accessor(view(std::vector<float>{0, 1}), kFloat, "SCALAR", 2);
    add("animations", json::object());
  }

  // `values`: the values at the start and at the end; of a cubic spline with their tangents.
  void animate(int node, const char* path, const char* type, const std::vector<float>& values,
               const char* interpolation = "LINEAR") {
    json& animation = root["animations"][0];
    const int count = std::string_view(interpolation) == "CUBICSPLINE" ? 6 : 2;
    animation["samplers"].push_back({{"input", times_},
                                     {"interpolation", interpolation},
                                     {"output", accessor(view(values), kFloat, type, count)}});
    animation["channels"].push_back({{"sampler", animation["samplers"].size() - 1},
                                     {"target", {{"node", node}, {"path", path}}}});
  }

  int addLamp(const char* name, const json& translation, int parent = -1) {
    root["extensionsUsed"] = {"KHR_lights_punctual"};
    root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 683}}};
    const int node = add("nodes", {{"name", name},
                                   {"translation", translation},
                                   {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    if (parent >= 0) root["nodes"][size_t(parent)]["children"] = {node};
    return node;
  }

 private:
  int times_;
};

Settings openShutterOfStillModel(double seconds, uint64_t steps) {
  Settings s;
  s.set("fps", 1.0);
  s.set("camera.shutter", seconds);
  s.set("camera.shutter_steps", steps);
  s.set("render.size", ImageSize{16, 12});
  return s;
}

Settings openShutterFor(double seconds, uint64_t steps) {
  Settings s = openShutterOfStillModel(seconds, steps);
  s.set("model.time", 0.0);
  return s;
}

LoadedScene loaded(const std::string& path, const Settings& settings) {
  RenderDescription description = planRender(openScene(path), settings);
  description.lamps.push_back({.ambient = AmbientLamp{Rgb(1)}});
  return loadScene(description);
}

bool says(const LoadedScene& scene, const std::string& text) {
  return std::ranges::any_of(scene.messages, [&](const Message& message) {
    return message.text.find(text) != std::string::npos;
  });
}

TEST(MotionKeys, LampsMoveThoughOneVanishes) {
  Animated w;
  addTriangle(w);
  const int ghost = w.addLamp("ghost", {0, 1, 0});
  const int mover = w.addLamp("mover", {0, 1, 0});
  w.animate(ghost, "scale", "VEC3", {1, 1, 1, 0, 0, 0}, "STEP");
  w.animate(mover, "translation", "VEC3", {-2, 1, 0, 2, 1, 0});
  const LoadedScene scene = loaded(w.save(), openShutterFor(1, 4));
  ASSERT_EQ(scene.scene.lights.size(), 2u);
  EXPECT_FALSE(scene.scene.lights[0].motion);
  for (const float time : {0.0f, 0.5f, 1.0f})
    EXPECT_NEAR(scene.scene.lights[1].poseAt(time).position.x, -2 + 4 * time, 1e-5);
  EXPECT_TRUE(says(scene, "`ghost` appears, vanishes or is mirrored"));
  EXPECT_FALSE(says(scene, "`mover`"));
}

TEST(MotionKeys, ACameraThatVanishesIsRefused) {
  Animated w;
  addTriangle(w);
  w.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", .8}, {"znear", .1}}}});
  const int camera = w.add("nodes", {{"camera", 0}, {"translation", {0, 0, 3}}});
  w.animate(camera, "scale", "VEC3", {1, 1, 1, 0, 0, 0}, "STEP");
  try {
    loaded(w.save(), openShutterFor(1, 4));
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("vanishes while the shutter is open"),
              std::string::npos)
        << error.what();
  }
}

// Half a turn along one chord: its middle is 1 m away from where the lamp or the camera is.
TEST(MotionKeys, WarnsOfLampsAndCamerasThatMissTheirWay) {
  Animated w;
  addTriangle(w);
  const std::vector<float> halfTurn{0, 0, 0, 1, 0, 1, 0, 0};
  const int arm = w.add("nodes", json::object()), boom = w.add("nodes", json::object());
  w.addLamp("lamp", {1, 0, 0}, arm);
  w.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", .8}, {"znear", .1}}}});
  w.root["nodes"][size_t(boom)]["children"] = {
      w.add("nodes", {{"camera", 0}, {"translation", {0, 0, 1}}})};
  w.root["scenes"] = {{{"nodes", {0, arm, boom}}}};
  w.animate(arm, "rotation", "VEC4", halfTurn);
  w.animate(boom, "rotation", "VEC4", halfTurn);
  const std::string path = w.save();
  const LoadedScene coarse = loaded(path, openShutterFor(1, 1));
  EXPECT_TRUE(says(coarse,
                   "the lamps move by up to 1.4 m while the shutter is open, and 1 step "
                   "misses their way by up to 1 m; 4 steps of the shutter"));
  EXPECT_TRUE(says(coarse,
                   "the camera moves by up to 1.4 m while the shutter is open, and 1 step "
                   "misses its way by up to 1 m; 4 steps of the shutter"));
  const LoadedScene fine = loaded(path, openShutterFor(1, 64));
  EXPECT_FALSE(says(fine, "the lamps"));
  EXPECT_FALSE(says(fine, "the camera"));
}

// A part that turns by whole turns from key to key seems to stand still.
// A motion that is over before the first of the shutter's own keys, or between two of them.
TEST(MotionKeys, MotionBetweenKeysIsMotion) {
  constexpr const char* kIdle = "has no effect without anything that moves";
  Animated w;
  const int node = addTriangle(w);
  w.animate(node, "translation", "VEC3", {0, 0, 0, 0, 1, 0});
  Animated pulse;  // away and back within its second
  const int beat = addTriangle(pulse);
  pulse.animate(beat, "scale", "VEC3", {0, 0, 0, 1, 1, 1, 0, 9, 0, 0, -9, 0, 1, 1, 1, 0, 0, 0},
                "CUBICSPLINE");
  Animated still;
  still.animate(addTriangle(still), "translation", "VEC3", {0, 1, 0, 0, 1, 0});
  const auto expectMissed = [&](Animated& model, double seconds, uint64_t steps) {
    const LoadedScene scene = loaded(model.save(), openShutterFor(seconds, steps));
    EXPECT_TRUE(says(scene, "their way by up to")) << seconds;
    EXPECT_FALSE(says(scene, kIdle)) << seconds;
  };
  expectMissed(pulse, 1, 1);
  expectMissed(pulse, 100, 8);
  expectMissed(w, 100, 8);
  EXPECT_FALSE(says(loaded(w.save(), openShutterFor(1, 8)), "their way"));
  Settings after = openShutterOfStillModel(1, 8);
  after.set("model.time", 2.0);
  EXPECT_TRUE(says(loaded(w.save(), after), kIdle));
  EXPECT_TRUE(says(loaded(still.save(), openShutterFor(1, 8)), kIdle));
}

TEST(MotionKeys, WarnsOfAWholeTurnBetweenKeys) {
  Animated w;
  const int node = addTriangle(w);
  const std::vector<float> times{0, .25f, .5f, .75f, 1};
  std::vector<float> turns;
  for (int i = 0; i < 5; ++i) {
    const float half = float(i) * kPi / 4;
    turns.insert(turns.end(), {0, 0, std::sin(half), std::cos(half)});
  }
  w.animate(node, "rotation", "VEC4", {0, 0, 0, 1, 0, 0, 0, 1});
  w.root["animations"][0]["samplers"][0] = {
      {"input", w.accessor(w.view(times), kFloat, "SCALAR", 5)},
      {"output", w.accessor(w.view(turns), kFloat, "VEC4", 5)}};
  EXPECT_TRUE(says(loaded(w.save(), openShutterFor(1, 1)), "the models move by up to 2 m"));
}

TEST(MotionKeys, WarnsOfATurnOfTheCameraThatKeysDoNotShow) {
  GltfWriter w;
  addTriangle(w);
  const std::string path = w.save();
  const auto turned = [&](double degrees) {
    Settings s = openShutterOfStillModel(1, 8);
    s.set("orbit-step", degrees);
    return loaded(path, s);
  };
  EXPECT_FALSE(says(turned(30), "the camera"));
  for (const double degrees : {720.0, 1440.0, 2880.0, 5760.0})
    EXPECT_TRUE(says(turned(degrees), "the camera ")) << degrees;
}

// With the option alone, the view is the same as for a turning camera.
TEST(MotionKeys, AStepOfTheOrbitFramesAsTheOrbitDoes) {
  GltfWriter w;
  addTriangle(w);
  const std::string path = w.save();
  Settings alone = openShutterOfStillModel(1, 8);
  alone.set("orbit-step", 40.0);
  Settings both = alone;
  both.set("orbit", 0.0);
  const Camera a = loaded(path, alone).camera, b = loaded(path, both).camera;
  EXPECT_EQ(a.position, b.position);
  ASSERT_TRUE(a.motion && b.motion);
  EXPECT_EQ(a.motion->back().position, b.motion->back().position);
}

// Tangents that are computed for a normal map may split vertices.
TEST(MotionKeys, AMorphWithANormalMapKeepsItsVertices) {
  Animated w;
  w.write("texels.png", kPng);
  w.add("images", {{"uri", "texels.png"}});
  w.add("textures", {{"source", 0}});
  w.add("materials", {{"normalTexture", {{"index", 0}}}});
  const int mesh =
      w.mesh({{"material", 0},
              {"indices", w.indices({0, 1, 2, 0, 2, 3})},
              {"attributes",
               {{"POSITION", w.vec3s({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0})},
                {"NORMAL", w.vec3s({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1})},
                {"TEXCOORD_0", w.vec2s({0, 1, 1, 1, 1, 0, 0, 0})}}},
              // The second triangle is folded over the first.
              {"targets", {{{"POSITION", w.vec3s({0, 0, 0, 0, 0, 0, 0, 0, 0, 1, -1, 0})}}}}});
  w.root["meshes"][size_t(mesh)]["weights"] = {0};
  const int node = w.add("nodes", {{"mesh", mesh}});
  w.animate(node, "weights", "SCALAR", {0, 1});
  const LoadedScene scene = loaded(w.save(), openShutterFor(1, 4));
  EXPECT_FALSE(says(scene, "appears, vanishes"));
  const auto& motion = scene.scene.instances.at(0).motion;
  ASSERT_TRUE(motion);
  EXPECT_EQ(motion->keys.back().mesh->positions.size(), 4u);
  EXPECT_EQ(motion->keys.back().point(3), vec3(1, 0, 0));
}

// A mirrored node whose mesh another node has too, until that one changes its shape: from then on
// it is stored in world space, where its triangles are wound the other way.
TEST(MotionKeys, AMirroredNodeMovesThoughItsMeshIsNoLongerShared) {
  for (const float sideways : {1.0f, -1.0f}) {
    Animated w;
    const int morphing =
        addTriangle(w, {{"targets", {{{"POSITION", w.vec3s({0, 0, 1, 0, 0, 1, 0, 0, 1})}}}}},
                    {{"weights", {0}}});
    const int moving = w.add("nodes", {{"mesh", 0}, {"scale", {sideways, 1, 1}}, {"weights", {0}}});
    w.animate(morphing, "weights", "SCALAR", {0, 1});
    w.animate(moving, "translation", "VEC3", {0, 0, 0, 3, 0, 0});
    const LoadedScene scene = loaded(w.save(), openShutterFor(1, 2));
    EXPECT_FALSE(says(scene, "appears, vanishes")) << sideways;
    const Instance& instance = scene.scene.instances.at(1);
    ASSERT_TRUE(instance.motion) << sideways;
    const InstanceMotion& motion = *instance.motion;
    for (uint32_t v = 0; v < 3; ++v) {
      const vec3 way = motion.keys.back().point(v) - motion.keys.front().point(v);
      EXPECT_NEAR(glm::length(way - vec3(3, 0, 0)), 0, 1e-6f) << sideways;
    }
  }
}

// Everything vanishes: the frame shows the probe.
TEST(SlowMotionKeys, AFrameMayBeEmpty) {
  Animated w;
  const int node = addTriangle(w);
  w.animate(node, "scale", "VEC3", {1, 1, 1, 0, 0, 0}, "STEP");
  const std::string path = w.save();
  const TemporaryFolder out;
  writeImage(out / "grey.exr", constantProbe({8, 4}, Rgb(0.5f)));
  const auto run = [&](const char* frames, const std::vector<std::string>& more) {
    std::vector<std::string> all{"render",    path,    "--probe", out / "grey.exr", "--frames",
                                 frames,      "--fps", "2",       "--size",         "16x12",
                                 "--samples", "4",     "-o",      out / "f.#.exr",  "--overwrite"};
    all.insert(all.end(), more.begin(), more.end());
    return runCommand(all);
  };
  for (const char* shutter : {"0", "0.6"}) {
    const CommandResult result = run("0:3", {"--shutter", shutter});
    ASSERT_EQ(result.status, 0) << result.error;
    const Image first = readImage(out / "f.0.exr"), last = readImage(out / "f.3.exr");
    EXPECT_NE(first.texels, last.texels);
    for (int y = 0; y < last.height; ++y)
      for (int x = 0; x < last.width; ++x) EXPECT_EQ(last.rgb(x, y), Rgb(0.5f));
  }
  EXPECT_EQ(run("2:3", {}).status, 0) << "the first frame may be empty too";
}

TEST(SlowMotionKeys, EveryProbeMustFitIntoMemory) {
  GltfWriter w;
  addTriangle(w);
  const TemporaryFolder out;
  writeImage(out / "probe.0.exr", constantProbe({8, 4}, Rgb(1)));
  writeImage(out / "probe.1.exr", constantProbe({2048, 1024}, Rgb(1)));
  const CommandResult result = runCommand(
      {"render", w.save(), "--frames", "0:1", "--probe-sequence", out / "probe.#.exr", "--memory",
       "0.05", "--size", "8x8", "--samples", "1", "--quiet", "-o", out / "f.#.exr"});
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.error.find("the limit is 0.05 GB"), std::string::npos) << result.error;
}

}  // namespace
}  // namespace chromeball::motion_keys_test
