// SPDX-License-Identifier: Apache-2.0
// Light groups: layers by source, which add up to the picture, and `image relight`.
#include "transport/light_groups.h"

#include <gtest/gtest.h>

#include <fstream>

#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "lighting/export/light_file.h"
#include "probe/synth.h"
#include "run_command.h"
#include "small_scenes.h"

namespace chromeball::light_groups_test {
namespace {

using Strings = std::vector<std::string>;

// A floor under an emissive and an unlit triangle, lit by a probe with a sun and by lamps.
class LitScene {
 public:
  explicit LitScene(const std::string& lights = kLights) {
    writer_.add("materials",
                {{"pbrMetallicRoughness", {{"metallicFactor", 0.5}, {"roughnessFactor", 0.4}}}});
    writer_.add("materials", {{"emissiveFactor", {1, 0.5, 0.2}}, {"doubleSided", true}});
    writer_.add("materials", {{"extensions", {{"KHR_materials_unlit", nlohmann::json::object()}}},
                              {"doubleSided", true},
                              {"pbrMetallicRoughness", {{"baseColorFactor", {0.3, 0.2, 0.1, 1}}}}});
    addTriangle(writer_, {{"material", 0}}, {{"name", "node0"}});
    addTriangle(writer_, {{"material", 1}}, {{"name", "node1"}, {"translation", {0.2, 0.5, 0.6}}});
    addTriangle(writer_, {{"material", 2}},
                {{"name", "node2"}, {"translation", {-0.6, -0.3, 0.4}}});
    writer_.save();
    Image sky = gradientProbe({64, 32}, Rgb(0.4f, 0.5f, 0.7f), {0.2, 0.9, 0.1});
    addSunDisc(sky, glm::normalize(dvec3(0.3, 0.5, 0.6)), 4, dvec3(3, 2, 1));
    writeImage(*this / "sky.exr", sky);
    write("a.toml", lights);
  }
  void write(const std::string& name, const std::string& lights) const {
    std::ofstream(*this / name)
        << "model = 'model.gltf'\n[camera]\nposition = [0.3, 0.3, 2]\nlook_at = [0.3, 0.3, 0]\n"
           "fov = 50\n[probe]\nfile = 'sky.exr'\n[render]\nsize = [16, 12]\nsamples = 16\n"
           "adaptive = 'off'\nguide = 'off'\n"
        << lights;
  }
  std::string operator/(const std::string& name) const { return writer_.folder() / name; }

  static constexpr const char* kLights =
      "[[light]]\nname = 'lamp'\ntype = 'point'\nposition = [0.1, 0.2, 0.5]\nintensity = 0.3\n"
      "[[light]]\ndirection = [0.2, -0.6, 0.8]\nirradiance = [1, 2, 3]\nangle = 5\n"
      "[[light]]\nname = 'a.b'\ntype = 'disc'\nposition = [0.5, 0.3, 0.5]\n"
      "direction = [0, 0, -1]\nradius = 0.1\nradiance = [3, 2, 1]\n";

 private:
  GltfWriter writer_;
};

ImageFile render(const LitScene& scene, Strings options, const std::string& file = "a.toml") {
  const std::string out = scene / "o.exr";
  Strings command{"render", scene / file, "-o", out};
  command.insert(command.end(), options.begin(), options.end());
  const CommandResult result = runCommand(command);
  EXPECT_EQ(result.status, 0) << result.error;
  return readImageFile(out);
}

Strings groupsOf(const ImageFile& file) {
  Strings names;
  for (const std::string& layer : layerNames(file))
    if (layer.starts_with("light.")) names.push_back(layer.substr(6));
  return names;
}

Image layer(const ImageFile& file, const std::string& name) {
  return findLayer(file, name).value();
}

double relativeDifference(const Image& a, const Image& b) {
  double worst = 0;
  for (size_t i = 0; i < a.texels.size(); ++i)
    worst = std::max(worst, std::fabs(double(a.texels[i]) - b.texels[i]) /
                                std::max(1e-3, std::fabs(double(a.texels[i]))));
  return worst;
}

// Groups add up with every strategy, and where the probe is on the walls of a room.
TEST(SlowLightGroups, AddUpToThePicture) {
  const LitScene scene;
  scene.write("room.toml",
              std::string(LitScene::kLights) +
                  "[surroundings]\nshape = 'sphere'\ncenter = [0, 0, 0]\nradius = 9\n");
  const auto check = [&](Strings options, const std::string& file) {
    SCOPED_TRACE(fmt::format("{} {}", fmt::join(options, " "), file));
    const Image plain = *findColor(render(scene, options, file));
    options.insert(options.end(), {"--aov", "light_groups"});
    const ImageFile grouped = render(scene, options, file);
    const Image color = *findColor(grouped);
    EXPECT_LT(relativeDifference(plain, color), 1e-3);  // rounding of directions near the sun
    Image sum(color.width, color.height, 3);
    for (const std::string& name : groupsOf(grouped)) {
      const Image part = layer(grouped, "light." + name);
      for (size_t i = 0; i < sum.texels.size(); ++i) {
        EXPECT_GE(part.texels[i], 0);
        sum.texels[i] += part.texels[i];
      }
    }
    EXPECT_LT(relativeDifference(color, sum), 1e-6);
  };
  scene.write("lamp.toml",
              "[[light]]\ntype = 'point'\nposition = [0.1, 0.2, 0.5]\nintensity = 1\n");
  for (const std::string_view strategy : strategyNames())
    check({"--strategy", std::string(strategy)}, "lamp.toml");
  check({"--strategy", "suns"}, "room.toml");
  check({"--strategy", "importance"}, "room.toml");
  check({"--clamp", "0.5"}, "a.toml");
  check({"--mis", "power"}, "a.toml");
}

TEST(LightGroups, HaveANameForEachSource) {
  const LitScene scene;
  EXPECT_EQ(groupsOf(render(scene, {"--aov", "light_groups"})),
            (Strings{"a_b", "lamp", "node1", "probe", "probe.suns", "sun", "unlit"}));
  const Strings fitted =
      groupsOf(render(scene, {"--aov", "light_groups", "--strategy", "median-cut:2"}));
  EXPECT_EQ(fitted,
            (Strings{"0", "1", "a_b", "ambient", "background", "lamp", "node1", "sun", "unlit"}));
}

// A group is the picture under its source alone: paths do not depend on the lights.
TEST(LightGroups, AreThePictureOfTheSourceAlone) {
  const LitScene scene;
  const ImageFile all = render(scene, {"--aov", "light_groups"});
  const std::string lamps = LitScene::kLights;
  // [[light]] blocks one at a time, under a black probe; the unlit and emissive nodes stay.
  writeImage(scene / "black.exr", Image(2, 1, 3));
  const auto alone = [&](const std::string& lights) {
    scene.write("alone.toml", lights);
    return *findColor(render(scene, {"--probe", scene / "black.exr"}, "alone.toml"));
  };
  const Image none = alone("");
  const size_t second = lamps.find("[[light]]", 1);
  const Image lamp = alone(lamps.substr(0, second));
  const Image group = layer(all, "light.lamp");
  for (size_t i = 0; i < lamp.texels.size(); ++i)
    EXPECT_NEAR(lamp.texels[i] - none.texels[i], group.texels[i], 1e-5 + 1e-5 * lamp.texels[i]);
  EXPECT_GT(meanColor(group).x, 0.01);
}

// Gains of powers of two are exact: the bits equal those of a render whose lights have them.
TEST(LightGroups, RelightToTheBitsOfARender) {
  const LitScene scene;
  const ImageFile before = render(scene, {"--aov", "light_groups"});
  ASSERT_EQ(std::rename((scene / "o.exr").c_str(), (scene / "groups.exr").c_str()), 0);
  std::string lights = LitScene::kLights;
  const auto replace = [&](const std::string& old, const std::string& value) {
    lights.replace(lights.find(old), old.size(), value);
  };
  replace("intensity = 0.3", "intensity = [0.3, 0.6, 0.075]");
  replace("irradiance = [1, 2, 3]", "irradiance = [4, 8, 12]");
  scene.write("changed.toml", lights);
  const ImageFile changed = render(scene, {"--aov", "light_groups"}, "changed.toml");
  const CommandResult result = runCommand({"image", "relight", scene / "groups.exr", "--gain",
                                           "sun=4,lamp=1,2,0.25", "-o", scene / "mixed.exr"});
  ASSERT_EQ(result.status, 0) << result.error;
  const ImageFile mixed = readImageFile(scene / "mixed.exr");
  EXPECT_EQ(findColor(mixed)->texels, findColor(changed)->texels);
  EXPECT_NE(findColor(mixed)->texels, findColor(before)->texels);
  for (const std::string& name : groupsOf(changed))
    EXPECT_EQ(layer(mixed, "light." + name).texels, layer(changed, "light." + name).texels) << name;
}

TEST(LightGroups, RelightKeepsTheHeaderOfACrop) {
  const LitScene scene;
  render(scene, {"--aov", "light_groups", "--crop", "4,5,6,3"});
  const ImageFile before = readImageFile(scene / "o.exr");
  ASSERT_EQ(
      runCommand({"image", "relight", scene / "o.exr", "--gain", "sun=2", "-o", scene / "r.exr"})
          .status,
      0);
  const ImageFile after = readImageFile(scene / "r.exr");
  for (const ImageFile& file : {before, after}) {
    ASSERT_TRUE(file.placement);
    EXPECT_EQ((std::array{file.placement->x, file.placement->y, file.placement->width,
                          file.placement->height}),
              (std::array{4, 5, 16, 12}));
  }
  EXPECT_EQ(std::get<std::string>(after.metadata.at("strategy")),
            std::get<std::string>(before.metadata.at("strategy")));
  EXPECT_TRUE(before.metadata.contains("noise"));
  EXPECT_FALSE(after.metadata.contains("noise"));
  EXPECT_EQ(std::get<std::string>(after.metadata.at("relit")), "gain=sun=2");
  ASSERT_EQ(runCommand({"image", "relight", scene / "r.exr", "--gain", "lamp=1,2,0.5", "-o",
                        scene / "again.exr"})
                .status,
            0);
  EXPECT_EQ(std::get<std::string>(readImageFile(scene / "again.exr").metadata.at("relit")),
            "gain=sun=2; then gain=lamp=1,2,0.5");
}

// EXR channels have 255 bytes at most. Long names that begin alike stay apart.
TEST(LightGroups, NamesAreUniqueAndShort) {
  const LitScene scene;
  const std::string longName(300, 'x');
  std::string lamps, lamp = "type = 'point'\nposition = [0.1, 0.2, 0.5]\nintensity = 0.3\n";
  for (const std::string& name :
       {longName + "1", longName + "2", std::string("a"), std::string("a_2"), std::string("a"),
        std::string("a"), std::string("probe.suns")})
    lamps += "[[light]]\nname = '" + name + "'\n" + lamp;
  scene.write("names.toml", lamps);
  Strings names = groupsOf(render(scene, {"--aov", "light_groups"}, "names.toml"));
  const std::string kept(200, 'x');
  EXPECT_EQ(names, (Strings{"a", "a_2", "a_3", "a_4", "node1", "probe", "probe.suns", "probe_suns",
                            "unlit", kept, kept + "_2"}));
}

// A plane under a constant probe (E = pi L) and one light: where the light is blocked, the factor
// is E_ambient / (E_ambient + E n.l).
TEST(LightGroups, ShadowMatteOfAPlane) {
  GltfWriter w;
  w.add("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                      {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}});
  addTriangle(w, {{"material", 0}});
  w.save();
  writeImage(w.folder() / "grey.exr", constantProbe({16, 8}, Rgb(0.2f, 0.3f, 0.5f)));
  writeLights(
      w.folder() / "l.json",
      {.probe = "p", .method = "m", .ambient = {}, .lights = {{{0, 0.6f, 0.8f}, {1, 2, 3}, 0}}});
  std::ofstream(w.folder() / "a.toml")
      << "model = 'model.gltf'\n[camera]\nposition = [0.3, 0.3, 2]\nlook_at = [0.3, 0.3, 0]\n"
         "fov = 2\n[probe]\nfile = 'grey.exr'\n[[light]]\nfile = 'l.json'\nname = 'key'\n";
  const CommandResult result = runCommand(
      {"render", w.folder() / "a.toml", "--size", "4x4", "--samples", "1024", "--max-depth", "1",
       "--aov", "shadow_mattes,light_groups", "-o", w.folder() / "o.exr"});
  ASSERT_EQ(result.status, 0) << result.error;
  const ImageFile file = readImageFile(w.folder() / "o.exr");
  const Rgb matte = meanColor(layer(file, "shadow.key_0"));
  const dvec3 ambient = kPiD * dvec3(0.2, 0.3, 0.5), light = 0.8 * dvec3(1, 2, 3);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(matte[k], ambient[k] / (ambient[k] + light[k]), 2e-3);
  const Rgb rest = meanColor(layer(file, "shadow.probe"));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(rest[k], light[k] / (ambient[k] + light[k]), 2e-3);
}

TEST(SlowLightGroups, SurviveShardsCropsAndCheckpoints) {
  const LitScene scene;
  const Strings groups{"--aov", "light_groups,shadow_mattes", "--samples", "32"};
  const auto with = [&](Strings more) {
    Strings options = groups;
    options.insert(options.end(), more.begin(), more.end());
    return options;
  };
  const ImageFile whole = render(scene, groups);
  for (const auto& [name, part] : std::vector<std::pair<std::string, Strings>>{
           {"1.exr", {"--crop", "0,0,16,5"}}, {"2.exr", {"--crop", "0,5,16,7"}}}) {
    render(scene, with(part));
    ASSERT_EQ(std::rename((scene / "o.exr").c_str(), (scene / name).c_str()), 0);
  }
  const CommandResult merged =
      runCommand({"merge", scene / "1.exr", scene / "2.exr", "-o", scene / "m.exr"});
  ASSERT_EQ(merged.status, 0) << merged.error;
  const ImageFile joined = readImageFile(scene / "m.exr");
  EXPECT_EQ(joined.channels, whole.channels);
  EXPECT_EQ(joined.image.texels, whole.image.texels);

  render(scene, {"--aov", "light_groups,shadow_mattes", "--samples", "16", "--checkpoint",
                 scene / "c.exr"});
  const ImageFile resumed = render(scene, with({"--checkpoint", scene / "c.exr", "--resume"}));
  EXPECT_EQ(resumed.image.texels, whole.image.texels);
}

TEST(LightGroups, RefuseWhatTheyCannotDo) {
  const LitScene scene;
  const Strings command{"render", scene / "a.toml", "-o", scene / "o.exr", "--aov", "light_groups"};
  const auto with = [&](Strings more) {
    Strings all = command;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  expectError(with({"--denoise"}), "add up");
  expectError(with({"--strategy", "median-cut:4096", "--size", "2000x2000", "--memory", "8"}),
              "light groups take");
  render(scene, {"--aov", "light_groups"});
  const auto relight = [&](const std::string& gains) {
    return Strings{"image", "relight", scene / "o.exr", "--gain", gains, "-o", scene / "r.exr"};
  };
  expectError(relight("lmap=2"), "`lamp`");
  expectError(relight("2"), "NAME=GAIN");
  for (const Strings& option : {Strings{"--bent"},
                                {"--suns"},
                                {"--add", scene / "o.exr"},
                                {"--probe-rotation", "30"},
                                {"--probe-scale", "3"},
                                {"--probe-mapping", "angular"}}) {
    Strings words = relight("sun=2");
    words.insert(words.end(), option.begin(), option.end());
    expectError(words, option.front() + ": has no effect with --gain");
  }
  for (const Strings& option : {Strings{"--exposure", "3"}, {"--tonemap", "aces"}}) {
    Strings words = relight("sun=2");
    words.insert(words.end(), option.begin(), option.end());
    expectError(words, option.front() + ": is for a .png");
  }
  expectError(relight("lamp=2,lamp=3"), "two gains");
  expectError(relight("lamp=1,2"), "3 numbers");
  expectError(relight("lamp="), "--gain lamp");
  expectError(relight("lamp=1e39"), "--gain lamp");
  expectError(relight("lamp=-1"), "negative");
  expectError(relight("probe=3e38,lamp=3e38,sun=3e38"), "largest float");
  expectError({"image", "relight", scene / "sky.exr", "--gain", "a=1", "-o", scene / "r.exr"},
              "no light groups");
  EXPECT_FALSE(std::filesystem::exists(scene / "r.exr"));
}

}  // namespace
}  // namespace chromeball::light_groups_test
