// SPDX-License-Identifier: Apache-2.0
// chromeball bake as a command; the baked model, rendered without light, looks like the original.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "base/json.h"
#include "browser.h"
#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "json_file.h"
#include "npm_packages.h"
#include "probe/synth.h"
#include "run_command.h"
#include "scene/gltf/load_gltf.h"
#include "shared_data.h"
#include "small_model.h"

namespace chromeball::command_bake_test {
namespace {

using Strings = std::vector<std::string>;

class CommandBake : public testing::Test {
 protected:
  CommandBake() {
    writeSmallModel(folder_ / "plate.gltf");
    writeImage(folder_ / "probe.exr", gradientProbe({32, 16}, Rgb(0.5f), {0.3, 0.6, 0.6}));
  }

  Strings with(const std::string& output, const Strings& more) const {
    Strings all{"bake", folder_ / "plate.gltf", "--probe", folder_ / "probe.exr",
                "-o",   folder_ / output};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  CommandResult bake(const std::string& output, Strings more) const {
    more.insert(more.end(), {"--samples", "4"});
    if (std::ranges::count(more, "vertices") == 0 && std::ranges::count(more, "--texel") == 0)
      more.insert(more.end(), {"--size", "32"});
    CommandResult result = runCommand(with(output, more));
    EXPECT_EQ(result.status, 0) << result.error;
    return result;
  }
  void refuses(const Strings& more, const std::string& reason,
               const std::string& output = "refused.glb") const {
    expectError(with(output, more), reason);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "refused.glb"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "refused.exr"));
  }
  // The contents of the baked model, and the messages.
  std::pair<std::string, std::string> occlusion(const std::string& model,
                                                const Strings& more) const {
    Strings words{"bake",      model, "--what", "ambient-occlusion", "--to", "vertices", "--quiet",
                  "--samples", "4",   "-o",     folder_ / "ao.glb"};
    words.insert(words.end(), more.begin(), more.end());
    const CommandResult result = runCommand(words);
    EXPECT_EQ(result.status, 0) << result.error;
    return {fileContents(folder_ / "ao.glb"), result.error};
  }
  static Scene load(const std::string& path) {
    return loadGltf(path, {}, [](const std::string& warning) { ADD_FAILURE() << warning; });
  }

  TemporaryFolder folder_;
};

TEST_F(CommandBake, IrradianceLightmapIsShownWithoutLight) {
  EXPECT_NE(bake("a.glb", {}).out.find("1 charts"), std::string::npos);
  const Scene scene = load(folder_ / "a.glb");
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_TRUE(scene.materials[0].unlit);
  EXPECT_EQ(scene.materials[0].baseColorTexture.uvSet, 1);
  EXPECT_EQ(scene.textures[0].grid->width, 32);
  EXPECT_EQ(scene.textures[0].wrapS, Wrap::ClampToEdge);
  EXPECT_EQ(scene.cameras.size(), 1u);
  const Image light = readImage(folder_ / "a.exr");
  EXPECT_EQ(light.width, 32);
  EXPECT_GT(light.rgb(16, 16).y, 0.5f);
}

TEST_F(CommandBake, NamesSettingsThatItDoesNotHeed) {
  std::ofstream(folder_ / "s.toml")
      << "model = 'plate.gltf'\n[probe]\nfile = 'probe.exr'\n[render]\nnoise = 3\n"
         "integrator = 'direct'\nao_distance = 0.5\nsize = [8, 6]\n[output]\naovs = ['ao']\n";
  const CommandResult result = runCommand({"bake", folder_ / "s.toml", "--to", "vertices",
                                           "--samples", "4", "--quiet", "-o", folder_ / "a.glb"});
  EXPECT_EQ(result.status, 0);
  EXPECT_TRUE(result.error.ends_with(
      "s.toml:5: render.noise, render.integrator, render.ao_distance, output.aovs have no effect "
      "here; `chromeball render` heeds them\n"))
      << result.error;
}

// A bake makes no image of the scene file's size, and needs no memory for it.
TEST_F(CommandBake, TheImagesSizeTakesNoMemory) {
  std::ofstream(folder_ / "s.toml") << "model = 'plate.gltf'\n[probe]\nfile = 'probe.exr'\n"
                                       "[render]\nsize = [16384, 8000]\n";
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"bake", "--to", "vertices"},
        std::vector<std::string>{"basis", "--at", "vertices", "--basis", "sh:1"}}) {
    std::vector<std::string> words = command;
    words.insert(words.end(),
                 {folder_ / "s.toml", "--samples", "4", "--memory", "2", "-o", folder_ / "a.glb"});
    const CommandResult result = runCommand(words);
    EXPECT_EQ(result.status, 0) << result.error;
    EXPECT_EQ(result.error.find("of memory"), std::string::npos) << result.error;
  }
}

TEST_F(CommandBake, OtherOutputs) {
  bake("ao.gltf", {"--what", "ambient-occlusion"});
  EXPECT_FALSE(load(folder_ / "ao.gltf").materials[0].unlit);
  const auto ao = jsonOfFile(folder_ / "ao.gltf");
  EXPECT_EQ(ao["materials"][0]["occlusionTexture"]["texCoord"], 1);
  EXPECT_EQ(ao["extras"]["chromeball"]["lightmap"], "ao.exr");
  EXPECT_TRUE(ao["meshes"][0]["primitives"][0]["attributes"].contains("TEXCOORD_0"));

  bake("v.gltf", {"--to", "vertices"});
  const auto v = jsonOfFile(folder_ / "v.gltf");
  EXPECT_TRUE(v["meshes"][0]["primitives"][0]["attributes"].contains("COLOR_0"));
  EXPECT_TRUE(v["meshes"][0]["primitives"][0]["attributes"].contains("_IRRADIANCE"));
  EXPECT_TRUE(load(folder_ / "v.gltf").materials[0].unlit);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "v.exr"));

  bake("k.gltf", {"--keep-materials", "--texel", "0.1", "--no-denoise"});
  const auto k = jsonOfFile(folder_ / "k.gltf");
  EXPECT_FALSE(k.contains("images"));
  EXPECT_TRUE(k["meshes"][0]["primitives"][0]["attributes"].contains("TEXCOORD_1"));
  bake("r.glb", {"--what", "radiance", "--white", "4"});
}

// Tangents that are not those of the UVs, on a mirrored node; and a texture that shows a line.
TEST_F(CommandBake, KeptMaterialsKeepTheirTangentsAndTransforms) {
  GltfWriter w;
  nlohmann::json primitive = {{"attributes",
                               {{"POSITION", w.vec3s({0, 0, 0, 1, 0, 0, 0, 1, 0})},
                                {"NORMAL", w.vec3s({0, 0, 1, 0, 0, 1, 0, 0, 1})},
                                {"TEXCOORD_0", w.vec2s({0, 0, 1, 0, 0, 1})}}},
                              {"material", 0}};
  const std::vector<float> tangents{0.6f, 0.8f, 0, 1, 0.6f, 0.8f, 0, 1, 0.6f, 0.8f, 0, 1};
  primitive["attributes"]["TANGENT"] = w.accessor(w.view(tangents), kFloat, "VEC4", 3);
  w.add("nodes", {{"mesh", w.mesh(primitive)}, {"scale", {-1, 1, 1}}});
  writeImage(w.folder() / "map.png", constantProbe({4, 4}, Rgb(0.5f)));
  w.add("images", {{"uri", "map.png"}});
  w.add("textures", {{"source", 0}});
  const nlohmann::json line = {
      {"scale", {0, 0.6}}, {"rotation", 0.7853981}, {"offset", {0.2, 0.3}}};
  w.add("materials", {{"normalTexture", {{"index", 0}}},
                      {"pbrMetallicRoughness",
                       {{"baseColorTexture",
                         {{"index", 0}, {"extensions", {{"KHR_texture_transform", line}}}}}}}});
  const std::string model = w.save(), baked = folder_ / "t.glb";
  ASSERT_EQ(runCommand({"bake", model, "--probe", folder_ / "probe.exr", "--to", "vertices",
                        "--keep-materials", "--samples", "4", "-o", baked})
                .status,
            0);
  const Scene from = load(model), to = load(baked);
  ASSERT_EQ(to.meshes[0].tangents.size(), 3u);
  for (const vec4& t : to.meshes[0].tangents)
    EXPECT_LT(glm::distance(t, vec4(-0.6f, 0.8f, 0, -1)), 1e-5f);
  const TextureSlot &given = from.materials[0].baseColorTexture,
                    &written = to.materials[0].baseColorTexture;
  for (const vec2 uv : {vec2(0), vec2(1, 0), vec2(0, 1), vec2(0.3f, 0.7f)})
    EXPECT_LT(glm::distance(given.transform(uv), written.transform(uv)), 1e-5f);
}

TEST_F(CommandBake, NeedsNoProbeForOcclusion) {
  EXPECT_EQ(runCommand({"bake", folder_ / "plate.gltf", "--what", "ambient-occlusion", "--size",
                        "32", "--samples", "2", "-o", folder_ / "ao.glb"})
                .status,
            0);
  expectError({"bake", folder_ / "plate.gltf", "-o", folder_ / "e.glb"}, "needs a probe");
}

TEST_F(CommandBake, OcclusionDoesNotDependOnLight) {
  const std::string model = folder_ / "plate.gltf";
  const auto plain = occlusion(model, {});
  EXPECT_EQ(plain.second, "");
  EXPECT_EQ(occlusion(model,
                      {"--probe", folder_ / "probe.exr", "--strategy", "suns", "--max-depth", "1"}),
            std::pair(plain.first, std::string("chromeball: warning: --probe, --strategy, "
                                               "--max-depth have no effect on occlusion\n")));
}

// As a key of the scene file, as an option, and the option before the key.
TEST_F(CommandBake, OcclusionHasTheDistanceOfTheSceneFile) {
  const auto baked = [&](const std::string& key, const Strings& more) {
    std::ofstream(folder_ / "d.toml")
        << "model = '" << kSourceDir << "/scenes/models/pillars.gltf'\n[render]\n"
        << key;
    const auto [contents, error] = occlusion(folder_ / "d.toml", more);
    EXPECT_EQ(error, "");
    return contents;
  };
  const auto nearby = baked("", {"--ao-distance", "0.01"});
  EXPECT_NE(nearby, baked("", {}));
  EXPECT_EQ(nearby, baked("ao_distance = 0.01\n", {}));
  EXPECT_EQ(nearby, baked("ao_distance = 7.0\n", {"--ao-distance", "0.01"}));
}

TEST_F(CommandBake, RefusesBadInput) {
  refuses({}, "must end in .glb or .gltf", "refused.obj");
  refuses({"--size", "1000000000"}, "--size: should be a whole number from 16 to 16384");
  refuses({"--size", "-3"}, "--size");
  refuses({"--size", "many"}, "--size");
  refuses({"--size", "16", "--padding", "8"}, "texels are too few");
  refuses({"--padding", "1e9"}, "--padding");
  refuses({"--texel", "1e-9"}, "need a page of more than 16384 x 16384");
  refuses({"--texel", "0"}, "--texel: should be a length above 0");
  refuses({"--texel", "nan"}, "--texel");
  refuses({"--texel", "1", "--size", "32"}, "excludes --size");
  refuses({"--what", "shadows"}, "irradiance, ambient-occlusion, radiance");
  refuses({"--to", "paint"}, "lightmap, vertices");
  refuses({"--to", "vertices", "--size", "32"}, "is for lightmaps");
  refuses({"--to", "vertices", "--denoise"}, ": --denoise: is for lightmaps");
  refuses({"--to", "vertices", "--no-denoise"}, ": --no-denoise: is for lightmaps");
  refuses({"--scale", "-1"}, "--white");
  refuses({"--samples", "1"}, "--samples");
  refuses({"--size", "16384", "--memory", "1"}, "limit");
  expectError({"bake", folder_ / "none.glb", "-o", folder_ / "refused.glb"}, "none.glb");
  expectError(with("plate.gltf", {}), "would overwrite the input");
}

// The mean difference of a baked model from its render, relative to the mean of the render.
double differenceOfBaked(const TemporaryFolder& folder, const Strings& bakeOptions,
                         const std::string& model, const std::string& probe) {
  const auto run = [](const Strings& words) {
    const CommandResult result = runCommand(words);
    EXPECT_EQ(result.status, 0) << result.error;
  };
  Strings words{"bake", model, "--probe", probe, "-o", folder / "baked.gltf", "--samples", "64"};
  words.insert(words.end(), bakeOptions.begin(), bakeOptions.end());
  run(words);
  run({"render", model, "--probe", probe, "--size", "120x80", "--samples", "64", "-o",
       folder / "render.exr", "--transparent", "--quiet"});
  run({"render", folder / "baked.gltf", "--size", "120x80", "--samples", "64", "-o",
       folder / "shown.exr", "--transparent", "--max-depth", "0", "--quiet"});
  const float scale = jsonOfFile(folder / "baked.gltf")["extras"]["chromeball"]["scale"];
  const Image a = readImage(folder / "render.exr"), b = readImage(folder / "shown.exr");
  double difference = 0, sum = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      difference += std::fabs(double(luminance(a.rgb(x, y)) - scale * luminance(b.rgb(x, y))));
      sum += double(luminance(a.rgb(x, y)));
    }
  return difference / sum;
}

TEST(SlowBake, BakedPillarsLookLikeTheRender) {
  const TemporaryFolder folder;
  const std::string model = std::string(kSourceDir) + "/scenes/models/pillars.gltf";
  const std::string probe = std::string(kSourceDir) + "/probes/noon.exr";
  EXPECT_LT(differenceOfBaked(folder, {"--size", "512"}, model, probe), 0.04);
  EXPECT_LT(differenceOfBaked(folder, {"--size", "512", "--what", "radiance"}, model, probe), 0.06);
}

TEST(SlowBake, ThreeJsShowsTheRender) {
  if (findChromium().empty()) GTEST_SKIP() << kNoChromium;
  const TemporaryFolder folder;
  if (!linkNpmPackages(folder / "")) GTEST_SKIP() << kNoNpmPackages;
  const std::string command =
      "cd '" + std::string(kSourceDir) + "' && SAMPLES=16 TEXELS=512 CHROMEBALL='" + kCommand +
      "' tools/scripts/bake_viewer.sh '" + folder / "" + "' > '" + folder / "found" + "' 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << fileContents(folder / "found");
}

TEST(SlowBake, RealModels) {
  const auto probe = sharedData("probes/polyhaven/studio_small_05_1k.hdr");
  if (!probe) GTEST_SKIP() << "without the shared data";
  const TemporaryFolder out;
  for (const char* name : {"Duck/glTF-Binary/Duck.glb", "BoxTextured/glTF-Binary/BoxTextured.glb"})
    for (const char* to : {"lightmap", "vertices"}) {
      const auto model = sharedData(std::string("gltf/") + name);
      if (!model) continue;
      const CommandResult result = runCommand({"bake", *model, "--probe", *probe, "--samples", "4",
                                               "--to", to, "-o", out / "baked.glb"});
      EXPECT_EQ(result.status, 0) << name << result.error;
      EXPECT_EQ(result.error.find("invalid"), std::string::npos) << result.error;
    }
}

}  // namespace
}  // namespace chromeball::command_bake_test
