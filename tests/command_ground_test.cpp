// SPDX-License-Identifier: Apache-2.0
// Composites without a modelled local scene, and through distorted lenses.
#include <gtest/gtest.h>

#include <array>
#include <fstream>

#include "base/hash.h"
#include "gltf_writer.h"
#include "image/io/write_image.h"
#include "json_file.h"
#include "probe/irradiance.h"
#include "probe/synth.h"
#include "run_command.h"

namespace chromeball::command_ground_test {
namespace {

// Adds the quad corner + s a + t b, s and t in [0, 1], as node.
void addQuad(GltfWriter& w, const std::string& name, vec3 corner, vec3 a, vec3 b) {
  std::vector<float> positions;
  for (const vec3& p : {corner, corner + a, corner + a + b, corner + b})
    for (int axis = 0; axis < 3; ++axis) positions.push_back(p[axis]);
  const int material =
      w.add("materials", {{"pbrMetallicRoughness",
                           {{"baseColorFactor", {0.25, 0.25, 0.25, 1}}, {"metallicFactor", 0}}},
                          {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}},
                          {"doubleSided", true}});
  w.root["extensionsUsed"] = {"KHR_materials_specular"};
  const int mesh = w.mesh({{"attributes", {{"POSITION", w.vec3s(positions)}}},
                           {"indices", w.indices({0, 1, 2, 0, 2, 3})},
                           {"material", material}});
  w.add("nodes", {{"name", name}, {"mesh", mesh}});
}

constexpr int kWidth = 48, kHeight = 32;

// A board that stands on the ground, seen from the side, and a plate that is half sky.
class SlowCommandGround : public testing::Test {
 protected:
  SlowCommandGround() {
    addQuad(model_, "board", {-0.3f, 0, 0}, {0.6f, 0, 0}, {0, 0.8f, 0});
    addQuad(model_, "floor", {-400, -1e-5f, 400}, {800, 0, 0}, {0, 0, -800});
    model_.root["scenes"] = {{{"nodes", {0}}}, {{"nodes", {0, 1}}}};
    model_.root["scene"] = 1;
    model_.save();
    std::filesystem::copy(path("model.gltf"), path("with-floor.gltf"));
    model_.root["scene"] = 0;
    model_.save();
    probe_ = overcastProbe({32, 16}, Rgb(0.8f, 0.9f, 1), 0.3);
    probe_.setRgb(6, 3, Rgb(60, 50, 40));
    writeImage(path("probe.exr"), probe_);
    plate_ = Image(kWidth, kHeight, 3);
    for (size_t i = 0; i < plate_.texels.size(); ++i)
      plate_.texels[i] = 0.1f + 0.1f * toUnit(uint32_t(hash(i)));
    writeImage(path("plate.exr"), plate_);
  }

  std::string path(const std::string& name) const { return (model_.folder() / name).string(); }

  std::string scene(const std::string& composite, const std::string& camera = "",
                    const std::string& probe = "", const std::string& others = "",
                    const std::string& model = "model.gltf") const {
    std::ofstream(path("scene.toml"))
        << "model = \"" << model << "\"\n[camera]\nposition = [1, 1, 3]\nlook_at = [0, 0.5, 0]\n"
        << "fov = 40\n"
        << camera << "\n[probe]\nfile = \"probe.exr\"\n"
        << probe << "\n[composite]\nplate = \"plate.exr\"\n"
        << composite << "\n"
        << others << "\n";
    return path("scene.toml");
  }
  ImageFile render(const std::string& scene, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"render",     scene, "-o",    path("out.exr"),
                                          "--adaptive", "off", "--aov", "difference,alpha,l_noobj"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    if (std::count(more.begin(), more.end(), "--samples") == 0)
      arguments.insert(arguments.end(), {"--samples", "64"});
    const CommandResult r = runCommand(arguments);
    EXPECT_EQ(r.status, 0) << r.error;
    messages_ = r.error;
    return readImageFile(path("out.exr"));
  }
  void refuse(const std::string& scenePath, const std::string& reason) const {
    expectError({"render", scenePath, "-o", path("x.exr")}, reason);
  }

  // The number of pixels that no object covers or affects; they must be the plate's.
  int untouched(const ImageFile& file) const {
    const Image color = *findColor(file), difference = *findLayer(file, "difference");
    const Image alpha = *findLayer(file, "alpha");
    int count = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        if (difference.rgb(x, y) == Rgb(0) && *alpha.at(x, y) == 0) {
          ++count;
          EXPECT_EQ(color.rgb(x, y), plate_.rgb(x, y)) << x << " " << y;
        }
    return count;
  }

  GltfWriter model_;
  Image probe_, plate_;
  std::string messages_;
};

// Both renders have the same random numbers, so that only rounding, which decides whether a sample
// sees the sun, and the floor's far edges differ.
TEST_F(SlowCommandGround, HasTheShadowsOfAModelledPlane) {
  const Image automatic =
      *findLayer(render(scene("ground = true\nreflectance = \"model\"")), "difference");
  const Image modelled = *findLayer(
      render(scene("local_scene = \"floor\"", "", "", "", "with-floor.gltf")), "difference");
  double shadow = 0, difference = 0;
  for (size_t i = 0; i < automatic.texels.size(); ++i) {
    shadow += std::abs(modelled.texels[i]);
    difference += std::abs(modelled.texels[i] - automatic.texels[i]);
  }
  EXPECT_GT(shadow / double(automatic.texels.size()), 1e-3);
  EXPECT_LT(difference, 2e-2 * shadow);
}

// With nothing but plate, probe, camera and model, the ground alone looks as in the plate, if the
// probe is bright enough.
TEST_F(SlowCommandGround, LooksAsInThePlate) {
  const ImageFile file = render(scene("ground = true"));
  const Image ground = *findLayer(file, "l_noobj");
  const Rgb irradiance = Rgb(exactIrradiance(probe_, std::array{vec3(0, 1, 0)})[0]);
  ASSERT_GT(irradiance.x / kPi, 0.2f);  // the plate's brightest needs an albedo below 1
  int seen = 0;
  for (int y = kHeight * 3 / 4; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      // Noise of the light that reaches each pixel, 64 samples.
      EXPECT_NEAR(luminance(ground.rgb(x, y)) / luminance(plate_.rgb(x, y)), 1, 0.25);
      ++seen;
    }
  EXPECT_GT(seen, 300);
  EXPECT_GT(untouched(file), 100);
}

// Through a lens with distortion, the plate's own pixels stay where nothing is added, and the
// reflectance found is right for the pixels that show it.
TEST_F(SlowCommandGround, DistortedLensesKeepThePlate) {
  const std::string lens = "distortion = [-0.3, 0.1]\nprincipal_point = [0.45, 0.52]";
  const ImageFile bent = render(scene("ground = true", lens));
  EXPECT_GT(untouched(bent), 100);
  const Image ground = *findLayer(bent, "l_noobj");
  for (int y = kHeight * 3 / 4; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      EXPECT_NEAR(luminance(ground.rgb(x, y)) / luminance(plate_.rgb(x, y)), 1, 0.25);
  const Image straight = *findLayer(render(scene("ground = true")), "alpha");
  EXPECT_NE(findLayer(bent, "alpha")->texels, straight.texels);
}

// The plate is the ground itself under another exposure and white balance of the probe.
TEST_F(SlowCommandGround, ScalesTheProbeByThePlate) {
  const Rgb factor(2, 1, 0.5f), reflectance(0.4f, 0.3f, 0.2f);
  const Rgb irradiance = Rgb(exactIrradiance(probe_, std::array{vec3(0, 1, 0)})[0]);
  Image plate(kWidth, kHeight, 3);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) plate.setRgb(x, y, factor * reflectance * irradiance * kInvPi);
  writeImage(path("plate.exr"), plate);
  const std::string lines =
      "ground = true\nreflectance = \"model\"\n"
      "ground_reflectance = [0.4, 0.3, 0.2]\n"
      "ground_reflectance_range = [0.2, 0.4]";
  const ImageFile file =
      render(scene(lines, "", "scale = \"plate\"\nrotation = 70"), {"--stats", path("stats.json")});
  EXPECT_NE(messages_.find("the probe's scale is 2,1,0.5 by "), std::string::npos) << messages_;
  EXPECT_NE(messages_.find("they scatter by 0%"), std::string::npos) << messages_;
  const auto stats = jsonOfFile(path("stats.json"));
  EXPECT_NEAR(stats["probe_scale"]["scale"][2], 0.5, 1e-4);
  EXPECT_GT(stats["probe_scale"]["pixels"], kWidth * kHeight / 5);
  // The ground rendered with it has the plate's radiance, but for noise.
  const Image ground = *findLayer(file, "l_noobj");
  glm::dvec3 sum(0);
  int count = 0;
  for (int y = kHeight * 3 / 4; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x, ++count) sum += glm::dvec3(ground.rgb(x, y));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / count / plate.rgb(0, 0)[c], 1, 0.02);
  // A number on the command line comes first.
  constexpr const char* kIdle = "`composite.ground_reflectance_range` has no effect without";
  EXPECT_EQ(messages_.find(kIdle), std::string::npos);
  render(scene(lines, "", "scale = \"plate\""), {"--probe-scale", "1"});
  EXPECT_EQ(messages_.find("the probe's scale is"), std::string::npos);
  EXPECT_NE(messages_.find(kIdle), std::string::npos) << messages_;
}

// A bright desk in a dark room, and a probe of another colour: the light is that of the desk, on
// which the shadow has the desk's hue.
TEST_F(SlowCommandGround, TheGroundAroundTheObjectsTellsTheScale) {
  const auto isDesk = [](int x, int y) { return y > kHeight / 2 && x > 8 && x < 40; };
  for (size_t i = 0; i < plate_.pixels(); ++i) {
    const int x = int(i) % kWidth, y = int(i) / kWidth;
    plate_.setRgb(i, isDesk(x, y) ? Rgb(0.6f, 0.65f, 0.7f) : Rgb(0.09f, 0.05f, 0.03f));
  }
  writeImage(path("plate.exr"), plate_);
  const std::string lines = "ground = true", light = "scale = \"plate\"";
  render(scene(lines, "", light), {"--stats", path("stats.json")});
  EXPECT_EQ(messages_.find("too faint"), std::string::npos) << messages_;
  const auto linear = jsonOfFile(path("stats.json"))["probe_scale"];

  writeImage(path("plate.png"), plate_);
  std::string photograph = fileContents(scene(lines, "", light));
  photograph.replace(photograph.find("plate.exr"), 9, "plate.png");
  std::ofstream(path("photograph.toml")) << photograph;
  const Image shadow = *findLayer(
      render(path("photograph.toml"), {"--samples", "256", "--stats", path("stats.json")}),
      "difference");
  // A white surface would be 1: the reflectance is the desk's luminance, at most 0.5.
  EXPECT_NE(messages_.find("with reflectance 0.5;"), std::string::npos) << messages_;
  const auto found = jsonOfFile(path("stats.json"))["probe_scale"];
  EXPECT_NEAR(double(found["scale"][1]) / double(linear["scale"][1]), 0.5, 0.01);
  glm::dvec3 sum(0);
  for (size_t i = 0; i < shadow.pixels(); ++i)
    if (const Rgb change = shadow.rgb(i); maxComponent(change) < 0) sum += glm::dvec3(change);
  EXPECT_LT(sum.y, -0.5);
  // The sun is warmer than the sky. In light of the dark room's colour, under which the desk would
  // have to be whiter than white, the ratios are 1.8 and 0.6.
  EXPECT_NEAR(sum.x / sum.y, 0.6 / 0.65, 0.12);
  EXPECT_NEAR(sum.z / sum.y, 0.7 / 0.65, 0.12);
}

// A rug in the middle of a floor of another colour, both around the objects: by the part of the
// plate that shows the rug alone, the light has its brightness and colour.
TEST_F(SlowCommandGround, APartOfThePlateTellsTheScale) {
  Image plate(2 * kWidth, 2 * kHeight, 3);  // of twice the image's size
  for (size_t i = 0; i < plate.pixels(); ++i) {
    const int x = int(i) % plate.width, y = int(i) / plate.width;
    const bool isRug = x >= 40 && x < 60 && y >= 44, isDark = (x / 8 + y / 8) % 2 == 0;
    plate.setRgb(i, isRug ? Rgb(0.4f, 0.3f, 0.2f) : Rgb(isDark ? 0.01f : 0.06f));
  }
  writeImage(path("plate.exr"), plate);
  const std::string lines = "ground = true\nground_reflectance = 0.5";
  const auto part = [&](const char* value) {
    return scene(lines + "\nground_in_plate = " + value, "", "scale = \"plate\"");
  };
  const auto found = [&](const std::string& file) {
    render(file, {"--size", "48x32", "--stats", path("stats.json")});
    return jsonOfFile(path("stats.json"))["probe_scale"];
  };
  const auto around = found(scene(lines, "", "scale = \"plate\""));
  EXPECT_NE(messages_.find("(`ground_in_plate` in [composite])"), std::string::npos) << messages_;
  const auto rug = found(part("[40, 44, 60, 64]"));
  EXPECT_EQ(rug["pixels"], 100);
  EXPECT_NE(messages_.find("by 100 pixels of the ground with reflectance 0.5; they scatter by 0%"),
            std::string::npos)
      << messages_;
  const Rgb irradiance = Rgb(exactIrradiance(probe_, std::array{vec3(0, 1, 0)})[0]);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(double(rug["scale"][c]), kPiD * (0.4 - 0.1 * c) / (0.5 * double(irradiance[c])),
                1e-3 * double(rug["scale"][c]));
  EXPECT_LT(double(around["scale"][0]), 0.3 * double(rug["scale"][0]));

  refuse(part("[40, 44, 60]"), "`ground_in_plate` must be four numbers");
  refuse(part("[60, 44, 40, 64]"), "left before right");
  refuse(part("[-1, 44, 40, 64]"), "`ground_in_plate` must be");
  refuse(part("[40, 44, 60, 65]"), "`ground_in_plate` is not inside the plate");
  refuse(part("[40, 44, 40.1, 44.1]"), "no pixel shows the ground");
}

TEST_F(SlowCommandGround, RefusesWhatDoesNotFit) {
  refuse(scene(""), "[composite] has no `local_scene`; name its nodes, or give `ground = true`");
  refuse(scene("ground = false"), "[composite] has no `local_scene`");
  refuse(scene("ground = 3"), "`ground` must be true or false");
  refuse(scene("local_scene = \"board\"\nground_height = 1"),
         "`ground_height` needs `ground = true`");
  refuse(scene("ground = true\nground_height = 2"), "the camera is 1 m below the ground");
  refuse(scene("ground = true\nground_reflectance = 0"), "`ground_reflectance` must be");
  refuse(scene("ground = true\nground_reflectance_range = [0.5, 0.1]"),
         "`ground_reflectance_range` must be two numbers, the smaller one first");
  refuse(scene("ground = true\nlocal_scene = \"board\""), "no objects are left to be composited");
  refuse(scene("local_scene = \"board\"", "", "scale = \"plate\""),
         "scale = \"plate\" needs [composite] with `ground = true`");
  refuse(scene("ground = true", "", "scale = \"photo\""), "`scale` must be");
  const std::string box =
      "[surroundings]\nshape = \"box\"\nmin = [-5, -0.1, -5]\nmax = [5, 5, 5]\n";
  refuse(scene("ground = true", "", "scale = \"plate\"", box), "needs a distant probe");
  refuse(scene("ground = true\nground_height = -1", "", "", box),
         "the ground is outside of [surroundings]");
  render(scene("ground = true", "", "", box), {"--samples", "2"});
  refuse(scene("ground = true", "", "scale = \"plate\"",
               "[[light]]\ndirection = [0, 1, 0]\nradiance = 1\n"),
         "needs the probe as the only light");
  writeImage(path("plate.exr"), Image(kWidth, kHeight, 3));
  refuse(scene("ground = true", "", "scale = \"plate\""), "the plate is black where it shows");
  render(scene("ground = true\nground_height = 0.3"), {"--samples", "2"});
  EXPECT_NE(messages_.find("the model reaches 0.3 m below the ground"), std::string::npos)
      << messages_;
}

}  // namespace
}  // namespace chromeball::command_ground_test
