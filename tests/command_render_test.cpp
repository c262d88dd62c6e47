// SPDX-License-Identifier: Apache-2.0
// chromeball render, from the command line to the files it writes.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <set>

#include "base/json.h"
#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "json_file.h"
#include "probe/synth.h"
#include "run_command.h"

namespace chromeball::command_render_test {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

constexpr float kEmission = 0.75f;  // radiance of the scene's lamp
// A grey box of 1 m and to its right an emissive box of 0.2 m, with cameras in front (2 m from the
// face of the grey box) and to the left (4 m); and probes.
class RenderScene {
  GltfWriter writer_;

 public:
  const std::string model, gradient, constant;
  TemporaryFolder out;  // contains only the output of renders

  RenderScene()
      : model((makeModel(writer_), writer_.save())),
        gradient((writer_.folder() / "gradient.exr").string()),
        constant((writer_.folder() / "constant.exr").string()) {
    writeImage(gradient, gradientProbe({64, 32}, Rgb(1, 2, 3), vec3(0.6f, 0.5f, 0.3f)));
    writeImage(constant, constantProbe({8, 4}, Rgb(0.5f, 1, 2)));
  }

  std::string folder() const { return writer_.folder().string(); }

  // Renders the model and expects success.
  CommandResult render(const Words& options) const { return renderScene(model, options); }

  CommandResult renderScene(const std::string& scene, const Words& options) const {
    Words words{"render", scene};
    words.insert(words.end(), options.begin(), options.end());
    CommandResult result = runCommand(words);
    EXPECT_EQ(result.status, 0) << result.error;
    return result;
  }

  ImageFile image(const std::string& name) const { return readImageFile(out / name); }
  json stats(const std::string& name) const { return jsonOfFile(out / name); }

 private:
  static int addBox(GltfWriter& w, float side, const json& material) {
    std::vector<float> corners;
    for (int i = 0; i < 8; ++i)
      for (int axis = 0; axis < 3; ++axis) corners.push_back(i >> axis & 1 ? side / 2 : -side / 2);
    std::vector<uint16_t> indices;
    for (const auto& [a, b, c, d] : {std::array<uint16_t, 4>{0, 2, 3, 1},
                                     {4, 5, 7, 6},
                                     {0, 4, 6, 2},
                                     {1, 3, 7, 5},
                                     {0, 1, 5, 4},
                                     {2, 6, 7, 3}})
      indices.insert(indices.end(), {a, b, c, a, c, d});
    return w.mesh({{"attributes", {{"POSITION", w.vec3s(corners)}}},
                   {"indices", w.indices(indices)},
                   {"material", w.add("materials", material)}});
  }

  static void makeModel(GltfWriter& w) {
    const json grey = {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"metallicFactor", 0}};
    w.add("nodes", {{"mesh", addBox(w, 1, {{"pbrMetallicRoughness", grey}})}});
    w.add("nodes",
          {{"mesh", addBox(w, 0.2f, {{"emissiveFactor", {kEmission, kEmission, kEmission}}})},
           {"translation", {0.9, 0, 0}}});
    w.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}});
    w.add("nodes", {{"camera", 0}, {"name", "Front"}, {"translation", {0, 0, 2.5}}});
    const double half = std::sqrt(0.5);
    w.add("nodes", {{"camera", 0},
                    {"name", "Left"},
                    {"translation", {-4.5, 0, 0}},
                    {"rotation", {0, -half, 0, half}}});
  }
};

// The header of an EXR file (OpenEXR file layout, version 2).
struct ExrHeader {
  std::map<std::string, int> channels;  // 2: float32
  int compression = -1;                 // 3: ZIP
  std::set<std::string> attributes;
};

ExrHeader exrHeader(const std::string& path) {
  const std::string bytes = fileContents(path);
  ExrHeader header;
  size_t at = 8;
  const auto text = [&] {
    const std::string word(bytes.c_str() + at);
    at += word.size() + 1;
    return word;
  };
  const auto number = [&] {
    int32_t n;
    std::memcpy(&n, bytes.data() + at, sizeof n);
    at += sizeof n;
    return n;
  };
  for (std::string name = text(); !name.empty(); name = text()) {
    header.attributes.insert(name);
    const std::string type = text();
    const size_t end = size_t(number()) + at;
    if (name == "compression") header.compression = bytes[at];
    if (type == "chlist")
      for (std::string channel = text(); !channel.empty(); at += 12, channel = text())
        header.channels[channel] = number();
    at = end;
  }
  return header;
}

// A channel of a pixel by its full name; NaN where the file has no such channel.
float texel(const ImageFile& file, const std::string& channel, int x, int y) {
  const auto found = std::find(file.channels.begin(), file.channels.end(), channel);
  EXPECT_NE(found, file.channels.end()) << channel;
  return found == file.channels.end() ? NAN : file.image.at(x, y)[found - file.channels.begin()];
}

void expectWithin(const Image& image, const Image& expected, float relative) {
  ASSERT_EQ(image.texels.size(), expected.texels.size());
  for (size_t i = 0; i < image.texels.size(); ++i)
    ASSERT_NEAR(image.texels[i], expected.texels[i], relative * expected.texels[i] + 1e-6f) << i;
}

TEST(CommandRender, WritesEveryFormatLayerAndStatistic) {
  const RenderScene scene;
  Words options{"--probe",    scene.gradient,
                "--size",     "24x18",
                "--samples",  "3",
                "--threads",  "1",
                "--seed",     "7",
                "--strategy", "importance",
                "--stats",    scene.out / "stats.json",
                "--aov",      "albedo,normal,depth,variance",
                "--aov",      "samples,material,node,alpha"};
  for (const char* name : {"a.exr", "a.hdr", "a.pfm", "a.png"})
    options.insert(options.end(), {"-o", scene.out / name});
  const CommandResult result = scene.render(options);
  EXPECT_TRUE(result.out.starts_with("3 samples per pixel")) << result.out;
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 1);
  EXPECT_EQ(scene.out.files(), (Words{"a.exr", "a.hdr", "a.pfm", "a.png", "stats.json"}));

  const ExrHeader header = exrHeader(scene.out / "a.exr");
  std::set<std::string> names;
  for (const auto& [name, type] : header.channels) {
    names.insert(name);
    EXPECT_EQ(type, 2) << name;
  }
  EXPECT_EQ(names,
            (std::set<std::string>{"R", "G", "B", "albedo.R", "albedo.G", "albedo.B", "normal.X",
                                   "normal.Y", "normal.Z", "depth.Z", "variance.R", "variance.G",
                                   "variance.B", "samples", "material", "node", "alpha.A"}));
  EXPECT_EQ(header.compression, 3);
  EXPECT_FALSE(header.attributes.contains("tiles"));

  const ImageFile exr = scene.image("a.exr");
  const auto metadata = [&](const char* key) {
    const auto found = exr.metadata.find(key);
    EXPECT_NE(found, exr.metadata.end()) << key;
    return found == exr.metadata.end() ? Metadata::mapped_type{} : found->second;
  };
  EXPECT_TRUE(std::get<std::string>(metadata("Software")).starts_with("chromeball "));
  EXPECT_EQ(std::get<std::string>(metadata("scene")), scene.model);
  EXPECT_EQ(std::get<std::string>(metadata("strategy")), "importance");
  EXPECT_EQ(std::get<int>(metadata("samples")), 3);
  EXPECT_EQ(std::get<std::string>(metadata("seed")), "7");
  EXPECT_GT(std::get<float>(metadata("seconds")), 0);

  const json stats = scene.stats("stats.json");
  const auto count = [&](const char* kind) { return stats.at("rays").at(kind).get<uint64_t>(); };
  EXPECT_EQ(count("camera"), 3u * 24 * 18);
  EXPECT_GT(count("shadow"), 0u);
  EXPECT_GT(count("bounce"), 0u);
  EXPECT_EQ(std::get<std::string>(metadata("rays")),
            std::to_string(count("camera") + count("shadow") + count("bounce")));
  EXPECT_NEAR(std::get<float>(metadata("noise")), stats.at("noise").get<double>(), 1e-6);
  for (const char* phase : {"load", "build", "prepare", "render", "write"})
    EXPECT_GE(stats.at("seconds").at(phase).get<double>(), 0) << phase;
  EXPECT_EQ(stats.at("samples_per_pixel"), 3);
  EXPECT_EQ(stats.at("invalid_samples"), 0);
  EXPECT_GT(stats.at("noise").get<double>(), 0);
  EXPECT_GT(stats.at("peak_memory_bytes").get<uint64_t>(), 1u << 20);
  EXPECT_EQ(stats.at("strategy"), "importance");
  EXPECT_EQ(stats.at("threads"), 1);
  EXPECT_EQ(stats.at("triangles"), 24);
  EXPECT_TRUE(stats.at("version").is_string());

  const Image color = *findColor(exr);
  EXPECT_EQ(readImage(scene.out / "a.pfm").texels, color.texels);
  expectWithin(readImage(scene.out / "a.hdr"), color, 0.02f);
  EXPECT_EQ(readImage(scene.out / "a.png").width, 24);
  EXPECT_EQ(readImage(scene.out / "a.png").height, 18);
  // The central pixel shows the centre of the box's front face, 2 m away.
  const auto middle = [&](const char* channel) { return texel(exr, channel, 12, 9); };
  EXPECT_NEAR(middle("depth.Z"), 2, 1e-4f);
  EXPECT_NEAR(middle("normal.Z"), 1, 1e-5f);
  EXPECT_NEAR(middle("albedo.G"), 0.5f, 1e-5f);
  EXPECT_EQ(middle("samples"), 3);
  EXPECT_EQ(middle("material"), 1);
  EXPECT_EQ(middle("alpha.A"), 1);
  EXPECT_EQ(texel(exr, "alpha.A", 0, 0), 0);
}

// Checked also under a noise limit, where the remaining time is an extrapolation. A scene file from
// others may give an output a name that a terminal would obey.
TEST(CommandRender, NamesOfOutputsArePrintedPlainly) {
  const RenderScene scene;
  const std::string file = scene.folder() + "/scene.toml";
  std::ofstream(file) << "model = \"model.gltf\"\n[output]\n"
                         "file = \"a\\u001b]0;title\\u0007\\nb.exr\"\n";
  const std::string out =
      scene.renderScene(file, {"--probe", scene.constant, "--size", "4x3", "--samples", "1"}).out;
  EXPECT_TRUE(out.ends_with("/a b.exr\n")) << out;
  EXPECT_EQ(std::ranges::count_if(out, [](char c) { return c >= 0 && c < ' '; }), 1);
}

TEST(SlowCommandRender, ProgressSaysSamplesNoiseAndTimeLeft) {
  const RenderScene scene;
  const CommandResult result =
      runExecutable({"render", scene.model, "--probe", scene.gradient, "--size", "64x48", "--noise",
                     "0.001", "--progress", "-o", scene.out / "a.png"},
                    " remaining, ");
  EXPECT_EQ(result.status, 130) << result.error;
  for (const char* words : {" samples, noise ", "rays/s"})
    EXPECT_NE(result.error.find(words), std::string::npos) << result.error;
}

TEST(CommandRender, OneSampleHasNoNoiseEstimate) {
  const RenderScene s;
  const CommandResult result =
      s.render({"--probe", s.constant, "--size", "16x16", "--samples", "1", "-o", s.out / "a.exr"});
  EXPECT_NE(result.out.find("noise unknown"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("nan"), std::string::npos) << result.out;
}

TEST(SlowCommandRender, ImagesDependOnTheSeedButNotOnThreads) {
  const RenderScene scene;
  const auto render = [&](const char* threads, const char* seed) {
    scene.render({"--probe", scene.gradient, "--size", "40x30", "--samples", "4", "--threads",
                  threads, "--seed", seed, "-o", scene.out / "a.pfm"});
    return readImage(scene.out / "a.pfm").texels;
  };
  const auto one = render("1", "1");
  EXPECT_EQ(render("2", "1"), one);
  EXPECT_NE(render("2", "2"), one);
}

TEST(SlowCommandRender, TheCommandLineOverridesTheSceneFile) {
  const RenderScene scene;
  const std::string file = scene.folder() + "/scene.toml";
  std::ofstream(file) << "model = 'model.gltf'\n[camera]\nname = 'Left'\n[probe]\nfile = "
                         "'gradient.exr'\nscale = 3\n[lighting]\nstrategy = 'uniform'\n[render]\n"
                         "size = [10, 8]\nsamples = 2\nseed = 5\nmax_depth = 0\n[output]\nfile = '"
                      << scene.out / "file.exr"
                      << "'\naovs = ['depth']\n";
  scene.renderScene(file, {"--stats", scene.out / "file.json"});
  scene.renderScene(file, {"--stats",
                           scene.out / "line.json",
                           "--size",
                           "6x5",
                           "--samples",
                           "3",
                           "--strategy",
                           "bsdf",
                           "--seed",
                           "6",
                           "--max-depth",
                           "2",
                           "--probe",
                           scene.constant,
                           "--probe-scale",
                           "4",
                           "--camera",
                           "Front",
                           "--aov",
                           "albedo",
                           "-o",
                           scene.out / "line.exr"});
  EXPECT_EQ(scene.out.files(), (Words{"file.exr", "file.json", "line.exr", "line.json"}));

  const json byFile = scene.stats("file.json"), byLine = scene.stats("line.json");
  const auto settings = [](const json& j) {
    return Words{jsonText(j["width"]),    jsonText(j["height"]), jsonText(j["samples_per_pixel"]),
                 jsonText(j["strategy"]), jsonText(j["seed"]),   jsonText(j["max_depth"])};
  };
  EXPECT_EQ(settings(byFile), (Words{"10", "8", "2", "\"uniform\"", "5", "0"}));
  EXPECT_EQ(settings(byLine), (Words{"6", "5", "3", "\"bsdf\"", "6", "2"}));
  EXPECT_NEAR(texel(scene.image("file.exr"), "depth.Z", 5, 4), 4, 1e-4f);
  EXPECT_FALSE(findLayer(scene.image("line.exr"), "depth"));
  EXPECT_TRUE(findLayer(scene.image("line.exr"), "albedo"));
  EXPECT_EQ(findColor(scene.image("line.exr"))->rgb(0, 0), Rgb(2, 4, 8));
}

TEST(CommandRender, DepthZeroShowsEmissionAndBackgroundOnly) {
  const RenderScene scene;
  scene.render({"--probe", scene.constant, "--size", "64x48", "--samples", "4", "--max-depth", "0",
                "-o", scene.out / "a.pfm"});
  const Image image = readImage(scene.out / "a.pfm");
  EXPECT_EQ(image.rgb(0, 0), Rgb(0.5f, 1, 2));
  EXPECT_EQ(image.rgb(32, 24), Rgb(0));
  // The lamp: 0.9 m to the right, 2.4 m away; half the image height there is 2.4 tan(0.4).
  const int column = 32 + int(std::lround(0.9f / (2.4f * std::tan(0.4f)) * 24));
  EXPECT_EQ(image.rgb(column, 24), Rgb(kEmission));
}

TEST(SlowCommandRender, ProbeScaleAndRotation) {
  const RenderScene scene;
  const auto render = [&](const Words& more) {
    Words options{"--size", "32x24", "--samples", "4", "-o", scene.out / "a.pfm"};
    options.insert(options.end(), more.begin(), more.end());
    scene.render(options);
    return readImage(scene.out / "a.pfm");
  };
  // From the left, the box hides the lamp, whose radiance does not depend on the probe's scale.
  const Image one = render({"--probe", scene.gradient, "--camera", "Left", "--max-depth", "1"});
  Image two = render(
      {"--probe", scene.gradient, "--camera", "Left", "--max-depth", "1", "--probe-scale", "2"});
  for (float& x : two.texels) x /= 2;
  EXPECT_EQ(two.texels, one.texels);

  // A rotation by 90 degrees, counter-clockwise from above, moves -Z (the middle column) to -X (a
  // quarter of the width).
  const Image probe = readImage(scene.gradient);
  Image turned = probe;
  for (int y = 0; y < probe.height; ++y)
    for (int x = 0; x < probe.width; ++x)
      turned.setRgb(x, y, probe.rgb((x + probe.width / 4) % probe.width, y));
  writeImage(scene.folder() + "/turned.exr", turned);
  const Image byOption =
      render({"--probe", scene.gradient, "--probe-rotation", "90", "--max-depth", "0"});
  expectWithin(byOption, render({"--probe", scene.folder() + "/turned.exr", "--max-depth", "0"}),
               1e-4f);
}

TEST(SlowCommandRender, AdaptiveRendersTakeTheRequestedMean) {
  const RenderScene scene;
  const auto samples = [&](const char* adaptive) {
    scene.render({"--probe", scene.gradient, "--size", "64x48", "--samples", "64", "--adaptive",
                  adaptive, "--aov", "samples", "-o", scene.out / "a.exr", "--stats",
                  scene.out / "a.json"});
    EXPECT_EQ(scene.stats("a.json")["adaptive"].get<bool>(), adaptive == std::string("on"));
    return *findLayer(readImageFile(scene.out / "a.exr"), "samples");
  };
  const Image off = samples("off"), on = samples("on");
  EXPECT_EQ(off.texels, std::vector<float>(64 * 48, 64.0f));
  double sum = 0;
  for (const float count : on.texels) sum += count;
  EXPECT_NEAR(sum / (64 * 48), 64, 0.64);
  EXPECT_GE(*std::ranges::min_element(on.texels), 16);  // the pilot
  EXPECT_LT(*std::ranges::min_element(on.texels), 24);
  EXPECT_GT(*std::ranges::max_element(on.texels), 128);
  expectError({"render", scene.model, "--probe", scene.gradient, "--adaptive", "offf", "-o",
               scene.out / "a.exr"},
              "`off`");
}

TEST(CommandRender, GuidesOnlyRendersWithImportance) {
  const RenderScene scene;
  const auto arguments = [&](std::vector<std::string> more) {
    std::vector<std::string> all = {
        "render",    scene.model, "--probe", scene.gradient,      "--size",  "16x12",
        "--samples", "8",         "-o",      scene.out / "a.exr", "--stats", scene.out / "a.json"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  expectError(arguments({"--guide", "on", "--strategy", "suns"}), "--guide: ");
  expectError(arguments({"--guide", "always"}), "`always`");
  scene.render({"--probe", scene.gradient, "--size", "16x12", "--samples", "8", "--strategy",
                "suns", "-o", scene.out / "a.exr", "--stats", scene.out / "a.json"});
  EXPECT_FALSE(scene.stats("a.json")["guided"].get<bool>());
  // Few pixels teach no guide: that is said.
  const CommandResult idle = runCommand(arguments({"--guide", "on"}));
  EXPECT_EQ(idle.status, 0);
  EXPECT_NE(idle.error.find("--guide: nothing was guided"), std::string::npos) << idle.error;
}

TEST(SlowCommandRender, StopsAtTheTimeOrTheNoise) {
  const RenderScene scene;
  scene.render({"--probe", scene.gradient, "--size", "32x24", "--time", "1", "-o",
                scene.out / "a.exr", "--stats", scene.out / "time.json"});
  const json timed = scene.stats("time.json");
  EXPECT_GT(timed["seconds"]["render"].get<double>(), 0.5);
  EXPECT_LT(timed["seconds"]["render"].get<double>(), 4);  // on a busy machine
  EXPECT_GT(timed["samples_per_pixel"].get<int>(), 8);
  EXPECT_TRUE(timed["adaptive"].get<bool>());
  const double rays = timed["samples_per_pixel"].get<double>() * 32 * 24;
  EXPECT_NEAR(timed["rays"]["camera"].get<double>(), rays, 0.06 * rays);  // a small image

  const auto said = [&](const char* seconds, const char* samples) {
    return scene
        .renderScene(scene.model, {"--probe", scene.gradient, "--size", "32x24", "--time", seconds,
                                   "--samples", samples, "--quiet", "-o", scene.out / "a.exr"})
        .error;
  };
  for (const char* samples : {"2", "4", "1000"})
    EXPECT_NE(said("1e-9", samples)
                  .find("warning: --time: the first pass, which is always completed, took "),
              std::string::npos)
        << samples << said("1e-9", samples);
  EXPECT_EQ(said("100", "64"), "");

  scene.render({"--probe", scene.gradient, "--size", "32x24", "--noise", "2", "-o",
                scene.out / "a.exr", "--stats", scene.out / "noise.json"});
  const json measured = scene.stats("noise.json");
  EXPECT_LE(measured["noise"].get<double>(), 0.02);
  EXPECT_GT(measured["noise"].get<double>(), 0.005);
}

// The samples are at an end before the noise that was asked for; a limit that is met says nothing.
TEST(CommandRender, SaysThatTheNoiseIsHigherThanAskedFor) {
  const RenderScene scene;
  const auto said = [&](const char* noise) {
    const CommandResult result = scene.renderScene(
        scene.model, {"--probe", scene.gradient, "--size", "32x24", "--samples", "4", "--noise",
                      noise, "-o", scene.out / "a.exr", "--stats", scene.out / "a.json"});
    EXPECT_EQ(result.status, 0) << result.error;
    return result.error;
  };
  const std::string text = said("0.1");
  EXPECT_NE(text.find("chromeball: --noise: the noise is "), std::string::npos) << text;
  EXPECT_NE(text.find("%, not 0.1%: the limit of 4 samples per pixel ended the render before; see "
                      "--samples"),
            std::string::npos)
      << text;
  EXPECT_GT(scene.stats("a.json")["noise"], 0.001);
  EXPECT_EQ(said("99").find("the noise is"), std::string::npos);
}

TEST(CommandRender, SaysThatNothingWasClamped) {
  const RenderScene scene;
  const auto said = [&](const char* most) {
    return scene
        .renderScene(scene.model, {"--probe", scene.gradient, "--size", "16x12", "--samples", "2",
                                   "--clamp", most, "-o", scene.out / "a.exr"})
        .error;
  };
  EXPECT_NE(said("1e9").find("chromeball: --clamp: no sample was above 1e+09"), std::string::npos);
  EXPECT_EQ(said("0.01").find("no sample"), std::string::npos);
}

TEST(CommandRender, WritesAMapOfTheNoise) {
  const RenderScene scene;
  scene.render({"--probe", scene.gradient, "--size", "700x60", "--samples", "2", "-o",
                scene.out / "a.exr", "--noise-map", scene.out / "map.png"});
  const ImageFile map = readImageFile(scene.out / "map.png");
  EXPECT_EQ(map.image.width, 234);  // squares of 3 pixels
  EXPECT_EQ(map.image.height, 20);
  expectError({"render", scene.model, "--probe", scene.gradient, "-o", scene.out / "a.exr",
               "--noise-map", scene.out / "map.exr"},
              "map.exr");
}

TEST(SlowCommandRender, AnInterruptSavesTheImageSoFar) {
  const RenderScene scene;
  const CommandResult result =
      runExecutable({"render", scene.model, "--probe", scene.gradient, "--size", "64x48",
                     "--samples", "10000000", "--time", "60", "--progress", "-o",
                     scene.out / "a.exr", "--stats", scene.out / "a.json", "--aov", "albedo"},
                    " samples");  // a pass is done
  EXPECT_EQ(result.status, 130);
  EXPECT_NE(result.error.find("chromeball: interrupted; the image so far, of "), std::string::npos);
  EXPECT_TRUE(
      result.error.ends_with(" samples per pixel, is saved as " + (scene.out / "a.exr") + "\n"))
      << result.error;
  EXPECT_EQ(scene.out.files(), (Words{"a.exr", "a.json"}));
  EXPECT_EQ(scene.stats("a.json")["interrupted"], true);
  const ImageFile image = scene.image("a.exr");
  for (float texel : image.image.texels) ASSERT_TRUE(std::isfinite(texel));
  const Image color = *findColor(image);
  EXPECT_GT(*std::max_element(color.texels.begin(), color.texels.end()), 0);
}

TEST(SlowCommandRender, OptionsAndSceneFileHaveTheSameRanges) {
  const RenderScene scene;
  struct Setting {
    const char *option, *key, *maximum, *tooMany;
  };
  for (const Setting& s :
       {Setting{"--samples", "samples", "", "2000000001"},
        Setting{"--max-depth", "max_depth", "1000000", "2147483647"},
        Setting{"--max-transmission-depth", "max_transmission_depth", "1000000", "1000001"}}) {
    const Words words{"--probe", scene.constant, "--size", "4x3", "-o", scene.out / "a.exr"};
    const auto run = [&](const std::string& value, bool inFile) {
      const std::string file = scene.folder() + "/scene.toml";
      std::ofstream(file) << fmt::format("model = \"model.gltf\"\n[render]\n{} = {}\n", s.key,
                                         value);
      Words all{"render", inFile ? file : scene.model};
      all.insert(all.end(), words.begin(), words.end());
      if (!inFile) all.insert(all.end(), {s.option, value});
      return runCommand(all);
    };
    for (const bool inFile : {false, true}) {
      EXPECT_EQ(run(s.tooMany, inFile).status, 2) << s.key << inFile;
      if (*s.maximum) {
        EXPECT_EQ(run(s.maximum, inFile).status, 0) << s.key << inFile;
      }
    }
  }
}

TEST(SlowCommandRender, ErrorsAreOneLine) {
  const RenderScene scene;
  const std::string output = scene.out / "a.exr", corrupt = scene.folder() + "/corrupt.exr";
  const std::string whole = fileContents(scene.gradient);
  std::ofstream(corrupt, std::ios::binary) << whole.substr(0, whole.size() / 2);
  GltfWriter demanding;
  demanding.root["extensionsRequired"] = demanding.root["extensionsUsed"] = {"EXT_nonsense"};

  const auto expectInputError = [&](const Words& words, const std::string& named,
                                    const std::string& remedy) {
    Words all{"render"};
    all.insert(all.end(), words.begin(), words.end());
    const CommandResult result = expectError(all, remedy);
    EXPECT_NE(result.error.find(named), std::string::npos) << result.error;
  };
  const auto expectOptionError = [&](const Words& more, const std::string& remedy) {
    Words words{scene.model, "--probe", scene.gradient, "-o", output};
    words.insert(words.end(), more.begin(), more.end());
    expectInputError(words, more.front(), remedy);
  };
  expectInputError({scene.folder() + "/none.gltf", "-o", output}, "none.gltf", "no such file");
  expectInputError({scene.folder() + "/none.toml", "-o", output}, "none.toml", "no such file");
  expectInputError({scene.gradient, "-o", output}, "gradient.exr", ".gltf");
  expectInputError({scene.model, "--probe", scene.folder() + "/none.exr", "-o", output}, "none.exr",
                   "no such file");
  expectInputError({scene.model, "--probe", corrupt, "-o", output}, "corrupt.exr", "corrupt.exr: ");
  expectInputError({demanding.save(), "--probe", scene.gradient, "-o", output}, "model.gltf",
                   "EXT_nonsense");
  expectInputError({scene.model, "--probe", scene.gradient}, "model.gltf", "--output");
  expectOptionError({"--strategy", "importence"}, "`importance`");
  expectOptionError({"--show-lights"}, "the strategy has no lights");
  expectOptionError({"--show-lights", "--strategy", "kollig-keller-strata"}, "median-cut:64");
  expectOptionError({"--aov", "albdo"}, "`albedo`");
  expectOptionError({"--mis", "powr"}, "`power`");
  expectOptionError({"--camera", "Frnt"}, "`Front`");
  expectOptionError({"--size", "12by9"}, "WIDTHxHEIGHT");
  expectOptionError({"--size", "0x9"}, "WIDTHxHEIGHT");
  expectOptionError({"--samples", "0"}, "from 1 to 2000000000");
  expectOptionError({"--samples", "many"}, "many");
  expectOptionError({"--max-depth", "-1"}, "from 0 to 1000000");
  expectOptionError({"--time", "nan"}, "above 0");
  expectOptionError({"--noise", "0"}, "above 0");
  expectOptionError({"--probe-scale", "nan"}, "0 or more");
  expectOptionError({"--probe-rotation", "inf"}, "finite");
  expectOptionError({"--samplse", "4"}, "`--samples`");
  expectInputError({scene.model, "--probe", scene.gradient, "-o", scene.folder() + "/none/a.exr"},
                   "none/a.exr: ", "no folder");
  expectInputError({scene.model, "--probe", scene.gradient, "-o", scene.out / "a.bmp"},
                   "a.bmp: ", ".exr");
  EXPECT_EQ(scene.out.files(), Words{});
}

// Without a probe, a model with emission is rendered; without both, the command requires --probe.
TEST(SlowCommandRender, WithoutAProbeOnlyEmissionLights) {
  const RenderScene scene;
  scene.render({"--size", "8x6", "--samples", "1", "-o", scene.out / "a.pfm"});
  EXPECT_EQ(readImage(scene.out / "a.pfm").rgb(0, 0), Rgb(0));
  GltfWriter dark;
  addTriangle(dark);
  expectError({"render", dark.save(), "-o", scene.out / "b.exr"}, "--probe");
  EXPECT_EQ(scene.out.files(), Words{"a.pfm"});
}

// The command-line options recorded in an EXR header.
Words optionsIn(const ImageFile& file) {
  const std::string help = runCommand({"render", "--help", "all"}).out;
  Words options;
  for (const char* limited : {"noise", "samples"})
    if (const auto limit = metadataNumber(file.metadata, fmt::format("{}-limit", limited)))
      options.insert(options.end(), {fmt::format("--{}", limited), fmt::format("{}", *limit)});
  for (const auto& [name, value] : file.metadata) {
    // `noise` and `samples` are results, not options.
    if (help.find("--" + name + " ") == std::string::npos || name == "noise" || name == "samples")
      continue;
    std::string text;
    if (const auto number = metadataNumber(file.metadata, name))
      text = fmt::format("{}", *number);
    else
      text = std::get<std::string>(value);
    options.push_back("--" + name);
    if (text != "true") options.push_back(text);
  }
  return options;
}

TEST(SlowCommandRender, TheHeaderReproducesTheImage) {
  const RenderScene scene;
  const std::string file = scene.folder() + "/scene.toml";
  std::ofstream(file) << "model = 'model.gltf'\n[probe]\nfile = 'gradient.exr'\nscale = 3.3\n"
                         "rotation = 20\n[render]\nmax_depth = 2\nsamples = 3\nsize = [10, 8]\n";
  const std::string adaptive = scene.folder() + "/adaptive.toml";
  std::ofstream(adaptive) << "model = 'model.gltf'\n[probe]\nfile = 'gradient.exr'\n"
                             "[render]\nadaptive = 'off'\nsize = [20, 15]\n";
  // Most pixels have no noise, and the others may take four times the mean: less is taken.
  const std::string capped = scene.folder() + "/capped.toml";
  std::ofstream(capped) << "model = 'model.gltf'\n[probe]\nfile = 'gradient.exr'\n[render]\n"
                           "size = [20, 15]\n[camera]\nposition = [0.3, 0.3, 9]\n"
                           "look_at = [0.3, 0.3, 0]\n";
  const std::vector<std::pair<std::string, Words>> jobs = {
      {scene.model, {"--probe", scene.gradient, "--size", "20x15", "--samples", "4"}},
      {scene.model,
       {"--probe",
        scene.constant,
        "--probe-mapping",
        "lat-long",
        "--probe-rotation",
        "33.1",
        "--probe-scale",
        "0.7",
        "--size",
        "12x9",
        "--samples",
        "5",
        "--strategy",
        "median-cut:8",
        "--mis",
        "power",
        "--max-depth",
        "3",
        "--camera",
        "Left",
        "--seed",
        "18446744073709551615",
        "--clamp",
        "1.1",
        "--transparent",
        "--aov",
        "depth,node"}},
      {file, {"--mis", "off", "--seed", "9", "--noise", "30"}},
      {adaptive, {"--samples", "16"}},
      {capped, {"--samples", "100", "--transparent"}},
      {capped, {"--samples", "40", "--noise", "1", "--transparent"}},
      {file, {"--camera", "Left", "--probe-scale", "2"}}};
  for (const auto& [name, options] : jobs) {
    Words words = options;
    words.insert(words.begin(), {"render", name, "-o", scene.out / "a.exr"});
    ASSERT_EQ(runExecutable(words).status, 0);  // its command is recorded
    const ImageFile first = scene.image("a.exr");
    EXPECT_EQ(std::get<std::string>(first.metadata.at("scene")), name);
    Words again = optionsIn(first);
    again.insert(again.end(), {"-o", scene.out / "b.exr"});
    scene.renderScene(name, again);
    const ImageFile second = scene.image("b.exr");
    EXPECT_EQ(second.channels, first.channels) << name;
    EXPECT_EQ(second.image.texels, first.image.texels) << name;
    EXPECT_NE(std::get<std::string>(first.metadata.at("files")).find("model.gltf"),
              std::string::npos);

    // The recorded command, run by a shell.
    std::string command = std::get<std::string>(first.metadata.at("command"));
    ASSERT_EQ(std::system((command + " --quiet > /dev/null").c_str()), 0) << command;
    EXPECT_EQ(scene.image("a.exr").image.texels, first.image.texels) << command;
  }
}

// Numbers are stored as given, also where a float cannot hold them.
TEST(CommandRender, NumbersOfTheHeaderAreExact) {
  const RenderScene scene;
  const std::map<std::string, double> given = {
      {"shutter", 0.7},    {"orbit-step", 5.1}, {"fps", 23.976},         {"probe-scale", 1 / 3.0},
      {"ao-distance", .3}, {"clamp", 1.1},      {"probe-rotation", 33.1}};
  Words options{"--probe", scene.gradient, "--size", "8x6", "--samples",
                "2",       "--aov",        "ao",     "-o",  scene.out / "a.exr"};
  for (const auto& [name, number] : given)
    options.insert(options.end(), {"--" + name, fmt::format("{}", number)});
  scene.render(options);
  const Metadata metadata = scene.image("a.exr").metadata;
  for (const auto& [name, number] : given)
    EXPECT_EQ(metadataNumber(metadata, name), number) << name;
  for (const double noise : {7.0, 33.3, 57.29577951308232}) {
    scene.render({"--probe", scene.gradient, "--size", "4x3", "--noise", fmt::format("{}", noise),
                  "-o", scene.out / "b.exr"});
    const auto stated = metadataNumber(scene.image("b.exr").metadata, "noise-limit");
    EXPECT_EQ(stated.value() / 100, noise / 100);
  }
}

// A setting that was given in vain is named once, from wherever it is.
TEST(CommandRender, NamesSettingsWithoutEffect) {
  const RenderScene scene;
  const auto errorOf = [&](const std::string& file, const Words& more) {
    Words options{"--size", "4x3", "--samples", "2", "--quiet", "-o", scene.out / "a.exr"};
    options.insert(options.end(), more.begin(), more.end());
    return scene.renderScene(file, options).error;
  };
  const std::string lit = scene.folder() + "/lit.toml";
  std::ofstream(lit) << "model = 'model.gltf'\n[probe]\nscale = 2.5\n[lighting]\nlights = 0.5\n";
  const std::string error = errorOf(
      lit, {"--probe-rotation", "30", "--probe-mapping", "lat-long", "--strategy", "uniform"});
  for (const char* line :
       {"lit.toml:3: `probe.scale` has no effect without a probe\n",
        "lit.toml:5: `lighting.lights` has no effect without punctual lights of the models\n",
        "--probe-rotation has no effect without a probe\n",
        "--probe-mapping has no effect without a probe's file\n",
        "--strategy has no effect without a probe\n"})
    EXPECT_NE(error.find(line), std::string::npos) << line << error;
  const auto expectOne = [&](const Words& options, const std::string& needs) {
    Words all{"--probe", scene.gradient};
    all.insert(all.end(), options.begin(), options.end());
    EXPECT_EQ(errorOf(scene.model, all),
              needs.empty() ? ""
                            : fmt::format("chromeball: warning: {} has no effect without {}\n",
                                          options[0], needs));
  };
  expectOne({"--shutter-steps", "3"}, "an open shutter");
  expectOne({"--shutter", "0.5"}, "anything that moves");
  expectOne({"--shutter", "0.5", "--shutter-steps", "3", "--orbit-step", "1"}, "");
  expectOne({"--lights", "off"}, "punctual lights of the models");
  expectOne({"--light-units", "radiometric"}, "punctual lights of the models");
  expectOne({"--glass-shadows", "straight"}, "smooth bodies of glass");
  expectOne({"--max-transmission-depth", "3"}, "bodies of glass");
  expectOne({"--light-from", "rest"}, "suns");
  const std::string many = "paths of more bounces";
  expectOne({"--regularize", "--max-depth", "1"}, "paths of more bounces, or bodies of glass");
  expectOne({"--regularize", "--integrator", "direct"},
            "paths of more bounces, or bodies of glass");
  expectOne({"--regularize", "--max-depth", "2"}, "");
  expectOne({"--irradiance-cache", "0.3", "--max-depth", "1"}, many);
  expectOne({"--max-diffuse-depth", "8"}, "a higher limit of all bounces");
  expectOne({"--max-specular-depth", "1", "--integrator", "direct"},
            "a higher limit of all bounces");
  expectOne({"--probe-rotation", "30", "--probe-scale", "2", "--probe-mapping", "lat-long"}, "");
  expectOne({"--single-sided", "light"}, "");
}

TEST(CommandRender, TheHeaderHasTheCameraMatrices) {
  const RenderScene scene;
  scene.render({"--probe", scene.gradient, "--size", "24x18", "--samples", "1", "--camera", "Left",
                "-o", scene.out / "a.exr", "--stats", scene.out / "a.json"});
  const Metadata metadata = scene.image("a.exr").metadata;
  // Homogeneous row vector times matrix.
  const auto transformed = [&](const char* name, const glm::dvec3& point) {
    const Matrix44& m = std::get<Matrix44>(metadata.at(name));
    const glm::dvec4 p(point, 1);
    glm::dvec4 q(0);
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) q[column] += p[row] * m[size_t(4 * row + column)];
    return glm::dvec3(q) / q.w;
  };
  const auto expectNear = [](const glm::dvec3& a, const glm::dvec3& b) {
    EXPECT_NEAR(glm::distance(a, b), 0, 1e-6) << a.x << " " << a.y << " " << a.z;
  };
  // The camera is at (-4.5, 0, 0) and looks along +X, with +Z to the right. In camera space it
  // looks along +Z.
  expectNear(transformed("worldToCamera", {-4.5, 0, 0}), {0, 0, 0});
  expectNear(transformed("worldToCamera", {-0.5, 0.25, 2}), {2, 0.25, 4});
  const double half = std::tan(0.4), aspect = 24 / 18.0;
  const glm::dvec3 seen = transformed("worldToNDC", {-0.5, 0.25, 2});
  EXPECT_NEAR(seen.x, 0.5 + 2 / (2 * aspect * half * 4), 1e-6);
  EXPECT_NEAR(seen.y, 0.5 - 0.25 / (2 * half * 4), 1e-6);
  EXPECT_LT(transformed("worldToNDC", {-2, 0, 0}).z, seen.z) << "z must grow with distance";

  const json description = scene.stats("a.json").at("job");
  EXPECT_EQ(description.at("cameraPosition"), json({-4.5, 0, 0}));
  EXPECT_NEAR(description.at("cameraFov").get<double>(), glm::degrees(0.8), 1e-4);
  EXPECT_EQ(description.at("worldToCamera").size(), 16u);
  EXPECT_EQ(description.at("probe"), scene.gradient);
  EXPECT_EQ(description.at("probe-found"), "lat-long");
  EXPECT_EQ(description.at("mis"), "balance");
}

TEST(CommandRender, TheHeaderMapsNodeAndMaterialIdsToNames) {
  GltfWriter w;
  w.root["materials"] = {{{"name", "unused"}}, {{"name", "say \"x\"\n\xc3\xa9"}}};
  addTriangle(w, {{"material", 1}}, {{"name", "<Blatt>"}});
  const TemporaryFolder folder;
  writeImage(folder / "probe.exr", constantProbe({8, 4}, Rgb(1)));
  ASSERT_EQ(runCommand({"render", w.save(), "--probe", folder / "probe.exr", "--size", "16x16",
                        "--samples", "1", "--aov", "node,material", "-o", folder / "a.exr"})
                .status,
            0);
  const ImageFile file = readImageFile(folder / "a.exr");
  const auto manifest = [&](const char* layer) {
    return parseJson(std::get<std::string>(file.metadata.at(std::string("manifest/") + layer)));
  };
  const Image nodes = *findLayer(file, "node");
  const float node = *std::max_element(nodes.texels.begin(), nodes.texels.end());
  ASSERT_GE(node, 1);
  EXPECT_EQ(manifest("node"), json({{std::to_string(int(node)), "<Blatt>"}}));
  EXPECT_EQ(manifest("material"), json({{"1", "say \"x\"\n\xc3\xa9"}}));
}

}  // namespace
}  // namespace chromeball::command_render_test
