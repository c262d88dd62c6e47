// SPDX-License-Identifier: Apache-2.0
// chromeball render --frames: each frame is the still at its time, bit for bit.
#include <gtest/gtest.h>

#include <fstream>

#include "front/plan_render.h"
#include "front/sequence.h"
#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "run_command.h"
#include "session/render_loaded.h"
#include "shared_data.h"
#include "trace/built_geometry.h"

namespace chromeball::sequence_test {
namespace {

using Words = std::vector<std::string>;

const std::string kProbe = std::string(kSourceDir) + "/probes/dusk.exr";

// Two triangles: one moves by a metre per second along X, one has a texture.
class Moving {
 public:
  GltfWriter w;

  Moving() {
    w.write("texels.png", kPng);
    w.add("images", {{"uri", "texels.png"}});
    w.add("textures", {{"source", 0}});
    w.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    addTriangle(w);
    addTriangle(w, {{"material", 0}, {"attributes", {{"TEXCOORD_0", w.vec2s({0, 0, 1, 0, 0, 1})}}}},
                {{"translation", {0, 1, 0}}});
    const std::vector<float> times{0, 10};
    w.add("animations",
          {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
           {"samplers",
            {{{"input", w.accessor(w.view(times), kFloat, "SCALAR", 2)},
              {"output", w.vec3s({0, 0, 0, 10, 0, 0})}}}}});
    w.save();
  }

  // A scene file with the model; returns its path.
  std::string scene(const std::string& more = "") const {
    const std::string path = (w.folder() / "scene.toml").string();
    std::ofstream(path) << "model = \"model.gltf\"\n[probe]\nfile = \"" << kProbe << "\"\n" << more;
    return path;
  }
};

Words words(const std::string& scene, const Words& more, const std::string& output,
            const std::string& samples = "4") {
  Words all{"render",      scene, "--size",  "32x24", "--samples", samples,
            "--max-depth", "3",   "--quiet", "-o",    output};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

void run(const Words& arguments) {
  const CommandResult result = runCommand(arguments);
  EXPECT_EQ(result.status, 0) << result.error;
}

std::vector<float> texelsOf(const std::string& path) { return readImage(path).texels; }

// Renders frames at two per second, and three stills at their times, with settings from `still`.
void expectStills(const std::string& scene, const Words& more,
                  const std::function<Words(int)>& still, const std::string& range = "0:5") {
  const TemporaryFolder out;
  Words frames = more;
  frames.insert(frames.end(), {"--frames", range, "--fps", "2"});
  run(words(scene, frames, out / "frame.##.exr"));
  std::vector<float> before;
  for (const int number : {1, 2, 4}) {
    Words one = still(number);
    one.insert(one.end(), {"--animation-time", fmt::format("{}", 0.5 * number)});
    run(words(scene, one, out / "still.exr"));
    const std::vector<float> frame = texelsOf(out / fmt::format("frame.{:02}.exr", number));
    EXPECT_EQ(frame, texelsOf(out / "still.exr")) << number;
    EXPECT_NE(frame, before) << number;
    before = frame;
  }
}

TEST(SlowSequence, FramesAreStills) {
  const Moving model;
  const auto alike = [](int) { return Words{}; };
  expectStills(model.scene(), {}, alike);
  expectStills(model.scene("[camera]\nposition = [1, 1, 4]\nlook_at = [1, 0.5, 0]\n"), {}, alike);
}

// The coordinates of a scene that is far away are relative to its own centre, which moves.
TEST(SlowSequence, FramesFarAwayAreStills) {
  const Moving model;
  const std::string path = (model.w.folder() / "far.toml").string();
  std::ofstream(path)
      << "[model]\nfile = \"model.gltf\"\ntranslation = [1e6, 3, 0]\n[probe]\nfile = \"" << kProbe
      << "\"\n";
  for (const char* range : {"0:5", "1:4"})
    expectStills(
        path, {}, [](int) { return Words{}; }, range);
  const auto turned = [](int number) { return Words{"--orbit", fmt::format("{}", 60 * number)}; };
  expectStills(path, {"--orbit", "360"}, turned);
}

TEST(SlowSequence, FramesOfATurntableAreStills) {
  const Moving model;
  const auto turned = [](int number) { return Words{"--orbit", fmt::format("{}", 60 * number)}; };
  expectStills(model.scene(), {"--orbit", "360"}, turned);
}

TEST(SlowSequence, ProbeTurns) {
  const Moving model;
  const std::string keys = "rotation_keys = [[0, 20], [1, 10], [2, 50]]\n";
  expectStills(model.scene(keys), {}, [](int) { return Words{}; });
  const TemporaryFolder out;
  run(words(model.scene(keys), {"--animation-time", "1.5"}, out / "a.exr"));
  run(words(model.scene(), {"--animation-time", "1.5", "--probe-rotation", "30"}, out / "b.exr"));
  EXPECT_EQ(texelsOf(out / "a.exr"), texelsOf(out / "b.exr"));
  expectError(words(model.scene("rotation_keys = [[1, 10], [1, 50]]\n"), {}, out / "a.exr"),
              "must ascend");
}

TEST(SlowSequence, SeedsDifferIfAsked) {
  const Moving model;
  expectStills(model.scene("[render]\nseed = 5\n"), {"--seed-per-frame"}, [](int number) {
    return Words{"--seed", fmt::format("{}", 5 + number)};
  });
}

// Skins and morphs.
TEST(SlowSequence, FramesOfRealModelsAreStills) {
  for (const char* name : {"Fox/glTF/Fox.gltf", "SimpleMorph/glTF/SimpleMorph.gltf",
                           "RiggedFigure/glTF/RiggedFigure.gltf"}) {
    const auto model = sharedData(std::string("gltf/") + name);
    if (!model) GTEST_SKIP() << "no shared data: gltf/" << name;
    SCOPED_TRACE(name);
    expectStills(*model, {"--probe", kProbe}, [](int) { return Words{"--probe", kProbe}; });
  }
}

TEST(SlowSequence, LeavesFinishedFramesAlone) {
  const Moving model;
  const TemporaryFolder out;
  std::ofstream(out / "frame.1.exr") << "kept";
  const Words frames{"--frames", "0:2"};
  run(words(model.scene(), frames, out / "frame.#.exr"));
  EXPECT_EQ(out.files().size(), 3u);
  EXPECT_EQ(fileContents(out / "frame.1.exr"), "kept");
  run(words(model.scene(), {"--frames", "0:2", "--overwrite"}, out / "frame.#.exr"));
  EXPECT_EQ(readImage(out / "frame.1.exr").width, 32);
}

TEST(SlowSequence, OutputOfTheSceneFile) {
  const Moving model;
  const std::string scene = model.scene("[output]\nfile = \"out/of-scene.#.exr\"\n");
  run({"render", scene, "--frames", "0:1", "--size", "8x8", "--samples", "2"});
  EXPECT_TRUE(std::filesystem::exists(model.w.folder() / "out/of-scene.1.exr"));
  const TemporaryFolder out;
  run(words(model.scene("[output]\nfile = \"still.exr\"\n"), {"--frames", "0:0"},
            out / "frame.#.exr"));
  EXPECT_EQ(out.files(), Words{"frame.0.exr"});
}

TEST(Sequence, OneOfTheFrames) {
  const Moving model;
  const TemporaryFolder out;
  const Words all{"--frames", "1:9:4", "--orbit", "90"};
  run(words(model.scene(), all, out / "all.#.exr"));
  EXPECT_EQ(out.files(), (Words{"all.1.exr", "all.5.exr", "all.9.exr"}));
  Words one = all;
  one.insert(one.end(), {"--frame", "5"});
  run(words(model.scene(), one, out / "one.#.exr"));
  EXPECT_EQ(texelsOf(out / "one.5.exr"), texelsOf(out / "all.5.exr"));
}

// An image that exists is a finished one; a checkpoint keeps the samples of the next.
TEST(SlowSequence, SurvivesInterruption) {
  const Moving model;
  const TemporaryFolder out;
  const std::string samples = "20000";
  Words frames =
      words(model.scene(),
            {"--frames", "0:1", "--checkpoint", out / "frame.#.checkpoint.exr", "--progress"},
            out / "frame.#.exr", samples);
  const CommandResult stopped = runExecutable(frames, "samples, noise");
  EXPECT_EQ(stopped.status, 130) << stopped.error;
  EXPECT_EQ(out.files(), (Words{"frame.0.checkpoint.exr"}));
  frames.push_back("--resume");
  run(frames);
  run(words(model.scene(), {"--animation-time", "0"}, out / "still.exr", samples));
  EXPECT_EQ(texelsOf(out / "frame.0.exr"), texelsOf(out / "still.exr"));
  EXPECT_TRUE(std::filesystem::exists(out / "frame.1.exr"));
}

TEST(SlowSequence, PartsOfFramesMerge) {
  const Moving model;
  const TemporaryFolder out;
  const Words fixed{"--frames", "0:2:2", "--adaptive", "off", "--guide", "off"};
  const auto render = [&](Words more, const std::string& name) {
    more.insert(more.end(), fixed.begin(), fixed.end());
    run(words(model.scene(), more, out / (name + ".#.exr"), "8"));
  };
  render({}, "whole");
  render({"--shard", "1/2"}, "first");
  render({"--shard", "2/2"}, "second");
  render({"--crop", "0,0,32,10"}, "upper");
  render({"--crop", "0,10,32,14"}, "lower");
  const auto merged = [&](const std::string& a, const std::string& b) {
    run({"merge", out / a, out / b, "-o", out / "merged.exr", "--quiet"});
    return texelsOf(out / "merged.exr");
  };
  for (const std::string number : {"0", "2"}) {
    const std::vector<float> whole = texelsOf(out / ("whole." + number + ".exr"));
    const std::string end = "." + number + ".exr";
    EXPECT_EQ(merged("upper" + end, "lower" + end), whole);
    const std::vector<float> shards = merged("second" + end, "first" + end);
    ASSERT_EQ(shards.size(), whole.size());
    for (size_t i = 0; i < whole.size(); ++i)
      ASSERT_NEAR(shards[i], whole[i], 1e-6f * std::max(1.0f, whole[i]));
  }
  EXPECT_NE(texelsOf(out / "whole.0.exr"), texelsOf(out / "whole.2.exr"));
  expectError({"merge", out / "first.0.exr", out / "second.2.exr", "-o", out / "merged.exr"},
              "animation-time");
}

RenderDescription jobAt(const std::string& scene, double seconds, double degrees = 0) {
  Settings given;
  given.set("frames", std::string("0:9"));
  given.set("model.time", seconds);
  given.set("orbit", degrees);
  return planRender(openScene(scene), given);
}

TEST(Sequence, LoadsAndBuildsOnceWhatDoesNotChange) {
  const Moving model;
  FrameScene scene;
  RenderDescription first = jobAt(model.scene(), 0), turned = jobAt(model.scene(), 0, 30),
                    later = jobAt(model.scene(), 1);
  scene.show(first);
  const World* world = scene.prepared().world.get();
  const LightSource* lighting = scene.prepared().lighting.get();
  const vec3 position = scene.loaded().camera.position;
  const TexelGrid* texels = scene.loaded().scene.grids.at(0).get();
  const auto chain = scene.loaded().scene.textures.at(0).mipLevels;
  scene.show(turned);
  EXPECT_EQ(scene.prepared().world.get(), world);
  EXPECT_NE(scene.loaded().camera.position, position);
  const vec3 moving = scene.loaded().scene.meshes.at(0).positions.at(0);
  const MeshList::Shared still = scene.loaded().scene.meshes.shared(1);
  const std::shared_ptr<BuiltGeometry> built = scene.prepared().world->accel.built();
  EXPECT_EQ(built->builds(), 1);  // of the triangle that does not move
  scene.show(later);
  EXPECT_NE(scene.loaded().scene.meshes.at(0).positions.at(0), moving);
  EXPECT_EQ(scene.loaded().scene.meshes.shared(1), still);
  EXPECT_EQ(scene.prepared().world->accel.built(), built);
  EXPECT_EQ(built->builds(), 1);
  EXPECT_EQ(scene.prepared().lighting.get(), lighting);
  EXPECT_EQ(scene.loaded().scene.grids.at(0).get(), texels);
  EXPECT_EQ(scene.loaded().scene.textures.at(0).mipLevels, chain);
}

TEST(Sequence, BuildsNothingTwiceWhereTheProbeTurns) {
  const Moving model;
  const std::string path = model.scene("rotation_keys = [[0, 20], [1, 10]]\n");
  FrameScene scene;
  RenderDescription first = jobAt(path, 0), later = jobAt(path, 1);
  scene.show(first);
  const std::shared_ptr<BuiltGeometry> built = scene.prepared().world->accel.built();
  scene.show(later);
  EXPECT_EQ(scene.loaded().probe.rotation().yaw(), 10);
  EXPECT_EQ(scene.prepared().world->accel.built(), built);
  EXPECT_EQ(built->builds(), 1);
}

// Two triangles of one mesh, one of them moving, and one that appears after a second: structures
// over meshes are built once, and the structure of what does not move again when its indices
// change.
TEST(SlowSequence, BuildsInstancesOnce) {
  Moving model;
  GltfWriter& w = model.w;
  w.root["nodes"].push_back({{"mesh", 0}, {"translation", {0, 2, 0}}});
  w.root["nodes"].push_back({{"mesh", 1}, {"scale", {0, 0, 0}}});
  nlohmann::json& animation = w.root["animations"][0];
  const std::vector<float> times{0, 1};
  animation["samplers"].push_back({{"input", w.accessor(w.view(times), kFloat, "SCALAR", 2)},
                                   {"output", w.vec3s({0, 0, 0, 1, 1, 1})},
                                   {"interpolation", "STEP"}});
  animation["channels"].push_back({{"sampler", 1}, {"target", {{"node", 3}, {"path", "scale"}}}});
  w.save();
  const std::string path = model.scene();
  FrameScene scene;
  std::vector<int> builds;
  for (const double seconds : {0.0, 0.5, 1.0, 1.5}) {
    RenderDescription description = jobAt(path, seconds);
    scene.show(description);
    builds.push_back(scene.prepared().world->accel.built()->builds());
  }
  // The mesh of two instances, and the second triangle alone; from 1 s on its mesh has two as well.
  EXPECT_EQ(builds, (std::vector<int>{2, 2, 3, 3}));
  expectStills(path, {}, [](int) { return Words{}; });
}

// A material whose tables no frame before needed.
TEST(SlowSequence, MaterialsMayAppear) {
  Moving model;
  GltfWriter& w = model.w;
  const int sheen =
      w.add("materials", {{"extensions",
                           {{"KHR_materials_sheen",
                             {{"sheenColorFactor", {1, 1, 1}}, {"sheenRoughnessFactor", 0.5}}}}}});
  addTriangle(w, {{"material", sheen}}, {{"translation", {0, 0, 1}}});
  nlohmann::json& animation = w.root["animations"][0];
  const std::vector<float> times{0, 1};
  animation["samplers"].push_back({{"input", w.accessor(w.view(times), kFloat, "SCALAR", 2)},
                                   {"output", w.vec3s({0, 0, 0, 1, 1, 1})},
                                   {"interpolation", "STEP"}});
  animation["channels"].push_back({{"sampler", 1}, {"target", {{"node", 2}, {"path", "scale"}}}});
  w.save();
  expectStills(model.scene(), {}, [](int) { return Words{}; });
}

TEST(Sequence, LampsAreBuiltOnce) {
  const Moving model;
  const std::string path = model.scene(
      "[[light]]\ntype = \"disc\"\nposition = [0, 5, 0]\ndirection = [0, -1, 0]\nradius = 1\n"
      "radiance = 5\n");
  FrameScene scene;
  for (const double seconds : {0.0, 0.5, 1.0}) {
    RenderDescription description = jobAt(path, seconds);
    scene.show(description);
    EXPECT_EQ(scene.prepared().world->accel.built()->builds(), 1) << seconds;
  }
}

TEST(Sequence, FramesAreCheckedLikeStills) {
  const Moving model;
  const TemporaryFolder out;
  const CommandResult result =
      runCommand(words(model.scene(), {"--frames", "0:1", "--memory", "0.03"}, out / "f.#.exr"));
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.error.find("GB of memory"), std::string::npos) << result.error;
}

// A model's own time is for stills.
TEST(Sequence, NamesATimeInVain) {
  const Moving model;
  const std::string path = (model.w.folder() / "timed.toml").string();
  std::ofstream(path)
      << "[[model]]\nfile = 'model.gltf'\n[[model]]\nfile = 'model.gltf'\ntime = 2\n";
  const SceneFile scene = readSceneFile(path);
  Settings given;
  EXPECT_TRUE(Sequence(scene, given).messages().empty());
  given.set("frames", std::string("1:2"), "--frames");
  given.set("output.file", std::vector<std::string>{"#.exr"}, "-o");
  const Messages messages = Sequence(scene, given).messages();
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_TRUE(messages[0].text.ends_with(
      "timed.toml:5: `time` has no effect: frames have times of their own"))
      << messages[0].text;
}

TEST(Sequence, StillsThatWereMeantAsSequencesAreNoted) {
  SceneFile scene;
  const auto notes = [&](const Words& options) {
    Settings given;
    for (size_t i = 0; i < options.size(); i += 2) {
      const Setting& setting = settingNamed(options[i]);
      const std::string location = "--" + setting.option;
      given.set(setting.name(), parseSetting(setting, {options[i + 1]}, location), location);
    }
    std::string text;
    for (const Message& message : Sequence(scene, given).messages()) text += message.text + "\n";
    return text;
  };
  EXPECT_TRUE(notes({"turntable", "360"}).starts_with("--turntable: a turn of 360 degrees"));
  EXPECT_TRUE(notes({"orbit", "-720"}).starts_with("--orbit: a turn of -720 degrees"));
  EXPECT_NE(notes({"orbit", "360"}).find("--frames A:B"), std::string::npos);
  for (const char* turn : {"0", "90", "400"}) EXPECT_EQ(notes({"turntable", turn}), "") << turn;
  EXPECT_TRUE(notes({"output.file", "a/q.##.png"}).starts_with("--output: `a/q.##.png` is"));
  EXPECT_EQ(notes({"output.file", "c#/q.png"}), "");
  EXPECT_EQ(notes({"output.file", "q.##.png", "turntable", "360", "frames", "0:3"}), "");
}

TEST(Sequence, NamesFiles) {
  EXPECT_EQ(withNumber("a.####.exr", 7), "a.0007.exr");
  EXPECT_EQ(withNumber("a.#.exr", 12345), "a.12345.exr");
  EXPECT_EQ(withNumber("#/a.##.exr", 3), "#/a.03.exr");
  EXPECT_EQ(withNumber("##", 3), "03");
  EXPECT_EQ(withNumber("a.exr", 3), "a.exr");
}

// The light of moving models differs in each frame.
TEST(Sequence, EachFrameMayHaveItsCache) {
  const Moving model;
  const TemporaryFolder out;
  const auto cached = [&](const Words& more, const std::string& cache) {
    Words all{"--irradiance-cache", "0.5", "--cache", out / cache};
    all.insert(all.end(), more.begin(), more.end());
    const char* near = "[camera]\nposition = [0.5, 0.5, 4]\nlook_at = [0.5, 0.5, 0]\n";
    return words(model.scene(near), all, out / "frame.#.exr");
  };
  run(cached({"--frames", "0:1"}, "light.#.cache"));
  for (const char* name : {"light.0.cache", "light.1.cache"})
    EXPECT_TRUE(std::filesystem::exists(out / name)) << name;
  run(cached({}, "rest.cache"));
  expectError(cached({"--animation-time", "1"}, "rest.cache"), "`animation-time` was not given");
}

// Before the first is rendered.
TEST(Sequence, NoFrameWritesWhatAnotherReadsOrWrites) {
  const Moving model;
  const TemporaryFolder out;
  for (const char* name : {"probe.0000.exr", "probe.0001.exr"})
    std::filesystem::copy_file(kProbe, out / name);
  const auto frames = [&](const Words& more, const std::string& name) {
    return words(model.scene(), more, out / name);
  };
  expectError(
      frames({"--frames", "0:1", "--probe-sequence", out / "probe.####.exr"}, "probe.00#1.exr"),
      "would overwrite the input");
  expectError(frames({"--frames", "1:10:9", "-o", out / "g.#0.exr"}, "g.#.exr"),
              "would overwrite the other output");
  EXPECT_EQ(out.files().size(), 2u);
}

TEST(Sequence, RefusesWhatItCannotRender) {
  const Moving model;
  const TemporaryFolder out;
  const auto refused = [&](const Words& more, const std::string& reason,
                           const std::string& name = "frame.#.exr") {
    expectError(words(model.scene(), more, out / name), reason);
  };
  for (const char* frames : {"5:2", "3", "0:9:0", "-1:4", "0:99999999", "0:1:2:3"})
    refused({"--frames", frames}, "A:B or A:B:STEP");
  refused({"--fps", "12"}, "needs --frames");
  refused({"--overwrite"}, "needs --frames");
  refused({"--frames", "0:1", "--fps", "0"}, "--fps");
  refused({"--frames", "0:1", "--animation", "None"}, "no animation `None`");
  const std::string terrace = std::string(kSourceDir) + "/scenes/terrace.toml";
  expectError({"render", terrace, "--orbit", "9", "-o", out / "t.exr"}, "does not turn");
  refused({"--frames", "0:4:2", "--frame", "3"}, "not one of the frames");
  refused({"--frames", "0:1", "--animation-time", "2"}, "times of their own");
  refused({"--frames", "0:1", "--write-every", "2"}, "finished");
  refused({"--frames", "0:1"}, "no #", "frame.exr");
  refused({"--frames", "0:1", "--checkpoint", out / "c.exr"}, "no #");
  EXPECT_TRUE(out.files().empty());
}

TEST(Camera, TurnsAroundTheCentre) {
  const Camera camera = Camera::lookAt({0, 1, 5}, {0, 1, 0}, {0, 1, 0}, 1);
  const Camera quarter = camera.turnedAround({3, 7, 0}, 90);  // nearest on the line: (0, 1, 0)
  EXPECT_LT(glm::distance(quarter.position, vec3(5, 1, 0)), 1e-5f);
  EXPECT_LT(glm::distance(quarter.back, vec3(1, 0, 0)), 1e-6f);
  EXPECT_LT(glm::distance(quarter.right, vec3(0, 0, -1)), 1e-6f);
  EXPECT_LT(glm::distance(camera.turnedAround(vec3(0), 360).position, camera.position), 1e-5f);
  // Behind the camera there is nothing to turn around.
  EXPECT_LT(glm::distance(camera.turnedAround({0, 1, 9}, 90).position, camera.position), 1e-6f);
}

}  // namespace
}  // namespace chromeball::sequence_test
