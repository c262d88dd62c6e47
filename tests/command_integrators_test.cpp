// SPDX-License-Identifier: Apache-2.0
// render --integrator, compare --integrators and image relight --probe as commands.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "base/json.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "json_file.h"
#include "probe/synth.h"
#include "run_command.h"
#include "small_model.h"

namespace chromeball::command_integrators_test {
namespace {

using Strings = std::vector<std::string>;

// A triangle under a gradient probe.
class CommandIntegrators : public testing::Test {
 protected:
  CommandIntegrators() {
    writeSmallModel(folder_ / "plate.gltf");
    writeImage(folder_ / "probe.exr", gradientProbe({32, 16}, Rgb(0.5f), {0.3, 0.6, 0.6}));
  }
  Strings with(const Strings& more, const std::string& command = "render") const {
    Strings all{
        command,  folder_ / "plate.gltf", "--probe", folder_ / "probe.exr", "--size", "16x16",
        "--quiet"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  ImageFile render(const Strings& more) const {
    Strings all = with(more);
    all.insert(all.end(), {"-o", folder_ / "o.exr"});
    const CommandResult result = runCommand(all);
    EXPECT_EQ(result.status, 0) << result.error;
    return readImageFile(folder_ / "o.exr");
  }
  void refuses(const Strings& more, const std::string& reason) const {
    Strings all = with(more);
    all.insert(all.end(), {"-o", folder_ / "refused.exr"});
    expectError(all, reason);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "refused.exr"));
  }

  TemporaryFolder folder_;
};

TEST_F(CommandIntegrators, Render) {
  const Image direct = *findColor(render({"--integrator", "direct", "--samples", "4"}));
  EXPECT_EQ(direct.texels, findColor(render({"--max-depth", "1", "--samples", "4"}))->texels);
  for (const char* name : {"environment-map", "ambient-occlusion"}) {
    const ImageFile file = render({"--integrator", name, "--samples", "16", "--denoise"});
    EXPECT_EQ(std::get<std::string>(file.metadata.at("integrator")), name);
  }
  render({"--integrator", "environment-map", "--ao", "--reflection-occlusion", "--ao-distance",
          "0.5", "--samples", "4", "--strategy", "suns"});
}

TEST_F(CommandIntegrators, RefuseWhatTheyDoNotKnow) {
  refuses({"--integrator", "environment-mapp"}, "`environment-map`");
  refuses({"--ao"}, "--ao");
  refuses({"--reflection-occlusion"}, "--reflection-occlusion");
  refuses({"--ao-distance", "1"}, "--ao-distance");
  refuses({"--ao-distance", "1", "--integrator", "environment-map"}, "--ao-distance");
  refuses({"--ao-distance", "0", "--aov", "ao"}, "--ao-distance");
  refuses({"--integrator", "environment-map", "--regularize"}, "--regularize");
  refuses({"--integrator", "environment-map", "--aov", "light_groups"}, "light groups");
  refuses({"--integrator", "environment-map", "--strategy", "median-cut:4", "--show-lights"},
          "see --show-lights");
  refuses({"--integrator", "ambient-occlusion", "--max-diffuse-depth", "2"}, "limits of depth");
  refuses({"--max-diffuse-depth", "-1"}, "--max-diffuse-depth");
  refuses({"--bent", "flat"}, "--bent");
  refuses({"--bent", "uniform"}, "--bent: is for the layer");
}

class SlowCommandIntegrators : public CommandIntegrators {};

// Up to rounding errors, and each is named.
TEST_F(SlowCommandIntegrators, NameSettingsWithoutEffect) {
  const auto rendered = [&](Strings options) {
    options = with(options);
    options.insert(options.end(), {"--samples", "16", "-o", folder_ / "o.exr"});
    const CommandResult result = runCommand(options);
    EXPECT_EQ(result.status, 0) << result.error;
    return std::pair(findColor(readImageFile(folder_ / "o.exr"))->texels, result.error);
  };
  const auto areNear = [](const std::vector<float>& a, const std::vector<float>& b) {
    return std::ranges::equal(
        a, b, [](float x, float y) { return std::fabs(x - y) <= 1e-5f * std::fabs(y); });
  };
  const auto check = [&](const std::string& integrator, const std::vector<Strings>& idle,
                         const std::vector<Strings>& effective) {
    const auto plain = rendered({"--integrator", integrator});
    for (const auto* settings : {&idle, &effective})
      for (const Strings& setting : *settings) {
        Strings options{"--integrator", integrator};
        options.insert(options.end(), setting.begin(), setting.end());
        const auto [texels, error] = rendered(options);
        const bool isNamed =
            error.find(setting[0] + " has no effect without ") != std::string::npos;
        EXPECT_EQ(areNear(texels, plain.first), settings == &idle) << integrator << setting[0];
        EXPECT_EQ(isNamed, settings == &idle) << integrator << setting[0] << error;
      }
  };
  for (const char* name : {"environment-map", "ambient-occlusion"})
    check(name,
          {{"--strategy", "uniform"},
           {"--strategy", "median-cut:8"},
           {"--mis", "off"},
           {"--max-depth", "3"}},
          {{"--max-depth", "0"}, {"--clamp", "0.1"}});
  check("direct", {{"--max-depth", "3"}, {"--max-diffuse-depth", "1"}},
        {{"--strategy", "uniform"},
         {"--mis", "off"},
         {"--max-depth", "0"},
         {"--max-diffuse-depth", "0"}});
  // A layer of what paths find.
  EXPECT_EQ(
      rendered({"--integrator", "environment-map", "--aov", "irradiance", "--strategy", "uniform"})
          .second,
      "");
}

TEST_F(CommandIntegrators, HaveNoEstimateOfTheLightThatTheyCut) {
  const auto cut = [&](const Strings& more) {
    Strings all{"--samples", "4", "--stats", folder_ / "s.json"};
    all.insert(all.end(), more.begin(), more.end());
    render(all);
    return jsonOfFile(folder_ / "s.json")["depth_cut"];
  };
  EXPECT_TRUE(cut({"--irradiance-cache", "0.3"}).is_null());
  EXPECT_TRUE(cut({"--integrator", "environment-map"}).is_null());
  for (const char* limit :
       {"max_depth", "max_diffuse_depth", "max_specular_depth", "max_transmission_depth"})
    EXPECT_EQ(cut({})[limit], 0);
}

TEST_F(CommandIntegrators, RefuseSources) {
  std::ofstream(folder_ / "sources.toml")
      << "model = \"plate.gltf\"\n[probe]\nfile = \"probe.exr\"\n"
         "[[source]]\nprobe_polygon = [[4, 4], [12, 4], [8, 8]]\n";
  const Strings render{"render", folder_ / "sources.toml", "--size", "8x8", "--samples", "4",
                       "-o",     folder_ / "o.exr"};
  EXPECT_EQ(runCommand(render).status, 0);
  Strings mapped = render;
  mapped.insert(mapped.end(), {"--integrator", "environment-map"});
  expectError(mapped, "leave [[source]] out");
}

TEST_F(CommandIntegrators, HeedTheAngleOfSuns) {
  Image sky = constantProbe({256, 128}, Rgb(0.1f));
  sky.setRgb(0, 40, Rgb(9000));
  writeImage(folder_ / "probe.exr", sky);
  const Strings suns{"--integrator", "environment-map", "--strategy", "suns", "--samples", "16"};
  Strings wide = suns;
  wide.insert(wide.end(), {"--sun-angle", "60"});
  EXPECT_NE(findColor(render(suns))->texels, findColor(render(wide))->texels);
}

// The records depend neither on the view nor on where it is given: the scene file may give it too.
TEST_F(CommandIntegrators, CacheIrradianceForOtherCamerasOfASceneFile) {
  const auto command = [&](const std::string& rest) {
    std::ofstream(folder_ / "scene.toml") << "model = 'plate.gltf'\n[probe]\nfile = 'probe.exr'\n"
                                          << "[render]\nsize = [16, 16]\nsamples = 4\n"
                                          << "irradiance_cache = 0.3\n"
                                          << rest;
    return Strings{"render", folder_ / "scene.toml", "--quiet", "--cache", folder_ / "records",
                   "-o",     folder_ / "o.exr"};
  };
  const auto renders = [&](const std::string& rest) {
    const CommandResult result = runCommand(command(rest));
    EXPECT_EQ(result.status, 0) << result.error;
  };
  renders("");
  ASSERT_TRUE(std::filesystem::exists(folder_ / "records"));
  const std::string camera = "[camera]\nlook_at = [0, 0, 0]\nfov = 40\nposition = ";
  renders(camera + "[3, 2, 4]\n");
  renders(camera + "[3, 3, 4]\n");
  renders("# a comment\n" + camera + "[3, 3, 4]\n[output]\naovs = ['albedo']\n");
  expectError(command("max_depth = 3\n"), "is the cache of another scene: `max-depth`");
  expectError(command("[[light]]\ntype = 'sun'\ndirection = [1, 1, 1]\nirradiance = 2\n"),
              "is the cache of another scene: `scene-lights`");
}

TEST_F(CommandIntegrators, CacheIrradiance) {
  const std::string cache = folder_ / "records";
  const Strings cached{"--samples", "4", "--irradiance-cache", "0.3", "--cache", cache};
  const Image first = *findColor(render(cached));
  const auto size = std::filesystem::file_size(cache);
  EXPECT_EQ(first.texels, findColor(render(cached))->texels);
  EXPECT_EQ(std::filesystem::file_size(cache), size);
  Strings turned = cached;
  turned.insert(turned.end(), {"--orbit", "20"});
  render(turned);  // another view of the same light
  Strings layers = cached;
  layers.insert(layers.end(), {"--aov", "albedo,ao"});
  render(layers);
  for (const char* height : {"2", "3"}) {
    const std::string file = folder_ / (std::string("camera") + height + ".toml");
    std::ofstream(file) << "[camera]\nposition = [3, " << height
                        << ", 4]\nlook_at = [0, 0, 0]\nfov = 40\n";
    Strings placed = cached;
    placed.insert(placed.end(), {"--camera-file", file});
    render(placed);
  }
  Strings frames = with(cached);
  frames.insert(frames.end(), {"--orbit", "40", "--frames", "1:2", "-o", folder_ / "f#.exr"});
  EXPECT_EQ(runCommand(frames).status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "f2.exr"));
  Strings brighter = cached;
  brighter.insert(brighter.end(), {"--probe-scale", "2"});
  refuses(brighter, "is the cache of another scene: `probe-scale`");
  std::filesystem::resize_file(cache, size - 1);
  refuses(cached, "damaged");
  refuses({"--irradiance-cache", "0.3", "--cache", folder_ / "probe.exr"}, "overwrite the input");
  std::filesystem::copy_file(folder_ / "probe.exr", folder_ / "other.exr");
  refuses({"--irradiance-cache", "0.3", "--cache", folder_ / "other.exr"},
          "is not an irradiance cache");
  refuses({"--irradiance-cache", "0.3", "--cache", folder_ / "none/records"}, "none");
  refuses({"--cache", cache}, "--irradiance-cache");
  for (const char* error : {"0", "-1", "nan", "1.5", "x"})
    refuses({"--irradiance-cache", error}, "--irradiance-cache");
  refuses({"--irradiance-cache", "0.2", "--regularize"}, "--regularize");
  refuses({"--irradiance-cache", "0.2", "--integrator", "direct"}, "not with another integrator");
  refuses({"--irradiance-cache", "0.2", "--strategy", "bsdf"}, "without light samples");
  refuses({"--irradiance-cache", "0.2", "--aov", "light_groups"}, "light groups");
  refuses({"--irradiance-cache", "0.2", "--max-diffuse-depth", "2"}, "limits of depth");
}

TEST_F(CommandIntegrators, LimitDepthByKind) {
  const Image all = *findColor(render({"--samples", "4", "--strategy", "importance"}));
  const Image none = *findColor(render({"--samples", "4", "--strategy", "importance",
                                        "--max-diffuse-depth", "0", "--max-specular-depth", "0"}));
  EXPECT_NE(all.texels, none.texels);
  EXPECT_EQ(all.texels, findColor(render({"--samples", "4", "--strategy", "importance",
                                          "--max-diffuse-depth", "9", "--max-specular-depth", "9"}))
                            ->texels);
}

TEST_F(CommandIntegrators, RelightByAProbe) {
  const std::string layers = "albedo,normal,ao,bent_normal,alpha";
  render({"--aov", layers, "--samples", "64", "--max-depth", "1"});
  const std::string in = folder_ / "o.exr", out = folder_ / "relit.exr";
  const auto relight = [&](const Strings& more) {
    Strings all{"image", "relight", in, "-o", out};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  const std::string probe = folder_ / "probe.exr";
  for (const Strings& more : {Strings{}, {"--bent"}, {"--suns"}, {"--rotation", "30"}}) {
    Strings words{"--probe", probe};
    words.insert(words.end(), more.begin(), more.end());
    const CommandResult result = runCommand(relight(words));
    ASSERT_EQ(result.status, 0) << result.error;
  }
  ASSERT_EQ(runCommand(relight({"--probe", probe})).status, 0);
  const Image once = *findColor(readImageFile(out));
  const auto attributes = [](const std::string& file) { return readImageFile(file).metadata; };
  EXPECT_EQ(std::get<std::string>(attributes(out).at("relit")), "probe=" + probe);
  for (const char* name : {"probe", "command", "noise", "samples", "strategy", "files"}) {
    EXPECT_TRUE(attributes(in).contains(name)) << name;
    EXPECT_FALSE(attributes(out).contains(name)) << name;
  }
  for (const char* name : {"worldToCamera", "cameraFov", "size"})
    EXPECT_EQ(attributes(out).at(name), attributes(in).at(name)) << name;
  ASSERT_EQ(runCommand(relight({"--probe", probe, "--scale", "2,1,1", "--rotation", "30", "--bent",
                                "--suns", "--add", in}))
                .status,
            0);
  EXPECT_EQ(std::get<std::string>(attributes(out).at("relit")),
            "probe=" + probe + " rotation=30 scale=2,1,1 bent suns add=" + in);
  ASSERT_EQ(runCommand(relight({"--probe", probe, "--scale", "2"})).status, 0);
  const Image twice = *findColor(readImageFile(out));
  std::filesystem::copy_file(out, folder_ / "added.exr");
  ASSERT_EQ(runCommand(relight({"--probe", probe, "--add", folder_ / "added.exr"})).status, 0);
  const Image added = *findColor(readImageFile(out));
  for (size_t i = 0; i < once.texels.size(); ++i) {
    EXPECT_NEAR(twice.texels[i], 2 * once.texels[i], 1e-6);
    EXPECT_NEAR(added.texels[i], 3 * once.texels[i], 1e-6);
  }
  std::filesystem::remove(out);
  expectError(relight({}), "--gain, --probe");
  expectError(relight({"--probe", probe, "--gain", "a=1"}), "--gain, --probe");
  expectError(relight({"--probe", folder_ / "none.exr"}), "none.exr");
  expectError(relight({"--probe", probe, "--scale", "-1"}), "--probe-scale");
  expectError(relight({"--probe", probe, "--exposure", "nan"}), "--exposure");
  expectError(relight({"--probe", probe, "--exposure", "3"}), "--exposure: is for a .png");
  expectError(relight({"--probe", probe, "--tonemap", "aces"}), "--tonemap: is for a .png");
  expectError(relight({"--probe", probe, "--add", probe}), "pixels");
  expectError({"image", "relight", probe, "--probe", probe, "-o", out}, "albedo");
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(CommandIntegrators, SlowCompare) {
  const CommandResult result =
      runCommand(with({"--strategies", "importance,importance+diffuse-depth:6+specular-depth:2",
                       "--integrators", "path,ambient-occlusion,environment-map", "--samples", "4",
                       "--repeats", "3", "-o", folder_ / "report"},
                      "compare"));
  EXPECT_EQ(result.status, 2);  // limits of depth do not go with approximations
  const CommandResult rows =
      runCommand(with({"--strategies", "importance", "--integrators",
                       "path,direct,ambient-occlusion,environment-map", "--samples", "4",
                       "--repeats", "3", "-o", folder_ / "report"},
                      "compare"));
  ASSERT_EQ(rows.status, 0) << rows.error;
  const auto json = jsonOfFile(folder_ / "report/results.json");
  const std::string text = jsonText(json);
  for (const char* row :
       {"importance+direct", "importance+ambient-occlusion", "importance+environment-map"})
    EXPECT_NE(text.find(row), std::string::npos) << row;
  const CommandResult named =
      runCommand(with({"--strategies", "importance,importance+environment-map+ao", "--samples", "4",
                       "--repeats", "3", "-o", folder_ / "named"},
                      "compare"));
  ASSERT_EQ(named.status, 0) << named.error;
  EXPECT_NE(fileContents(folder_ / "named/results.json").find("importance+environment-map+ao"),
            std::string::npos);
  expectError(
      with({"--strategies", "importance", "--integrators", "raster", "-o", folder_ / "none"},
           "compare"),
      "raster");
}

}  // namespace
}  // namespace chromeball::command_integrators_test
