// SPDX-License-Identifier: Apache-2.0
// `chromeball render` of a scene file with [composite].
#include <gtest/gtest.h>

#include <fstream>

#include "base/hash.h"
#include "composite/plate.h"
#include "gltf_writer.h"
#include "image/io/write_image.h"
#include "json_file.h"
#include "probe/synth.h"
#include "run_command.h"
#include "shared_data.h"

namespace chromeball::command_composite_test {
namespace {

// Adds a node with the quad corner + s a + t b, s and t in [0, 1].
int addQuad(GltfWriter& w, const std::string& name, vec3 corner, vec3 a, vec3 b) {
  std::vector<float> positions;
  for (const vec3& p : {corner, corner + a, corner + a + b, corner + b})
    for (int axis = 0; axis < 3; ++axis) positions.push_back(p[axis]);
  const int material = w.add(
      "materials",
      {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"metallicFactor", 0}}},
       {"doubleSided", true}});
  const int mesh = w.mesh({{"attributes", {{"POSITION", w.vec3s(positions)}}},
                           {"indices", w.indices({0, 1, 2, 0, 2, 3})},
                           {"material", material}});
  return w.add("nodes", {{"name", name}, {"mesh", mesh}});
}

Image alphaOf(const ImageFile& file) {
  const auto channel = std::find(file.channels.begin(), file.channels.end(), "alpha.A");
  Image alpha(file.image.width, file.image.height, 1);
  for (int y = 0; y < alpha.height; ++y)
    for (int x = 0; x < alpha.width; ++x)
      *alpha.at(x, y) = file.image.at(x, y)[channel - file.channels.begin()];
  return alpha;
}

// A ground seen from above and a sail on its left half, with a plate and a probe.
class CommandComposite : public testing::Test {
 protected:
  CommandComposite() {
    addQuad(model_, "ground", {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
    const int sail = addQuad(model_, "sail", {-0.5f, 0, 0.2f}, {0, 0, -0.4f}, {0, 0.5f, 0});
    model_.add("nodes", {{"name", "boat"}, {"children", {sail}}});
    model_.root["scenes"] = {{{"nodes", {0, 2}}}};
    model_.save();
    writeImage(path("probe.hdr"), overcastProbe({16, 8}, Rgb(1), 0.3));
    writePlate(path("plate.exr"), 32, 16);
  }

  std::string path(const std::string& name) const { return (model_.folder() / name).string(); }

  static Image writePlate(const std::string& file, int width, int height) {
    Image plate(width, height, 3);
    for (size_t i = 0; i < plate.texels.size(); ++i) plate.texels[i] = toUnit(uint32_t(hash(i)));
    writeImage(file, plate);
    return plate;
  }

  // Writes a scene file with the lines `composite` in [composite], followed by `others`.
  std::string scene(const std::string& composite, const std::string& others = "") const {
    std::ofstream(path("scene.toml")) << "model = \"model.gltf\"\n"
                                         "[camera]\nposition = [0, 4, 0]\nlook_at = [0, 0, 0]\n"
                                         "up = [0, 0, -1]\nfov = 28\n"
                                         "[probe]\nfile = \"probe.hdr\"\n"
                                         "[composite]\n"
                                      << composite << "\n"
                                      << others << "\n";
    return path("scene.toml");
  }

  CommandResult render(const std::string& scenePath, std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"render", scenePath, "-o", path("out.exr")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    if (std::count(more.begin(), more.end(), "--samples") == 0)
      arguments.insert(arguments.end(), {"--samples", "16"});
    return runCommand(arguments);
  }
  void expectInputError(const std::string& scenePath, const std::string& reason) const {
    expectError({"render", scenePath, "-o", path("rejected.exr")}, reason);
    EXPECT_FALSE(std::filesystem::exists(path("rejected.exr")));
  }

  GltfWriter model_;
};

class SlowCommandComposite : public CommandComposite {};

constexpr const char* kGood = "plate = \"plate.exr\"\nlocal_scene = \"ground\"";

TEST_F(CommandComposite, WritesTheCompositeAndItsLayers) {
  const CommandResult r = render(
      scene(kGood),
      {"--aov", "l_obj,l_noobj,alpha,difference,variance,albedo", "--stats", path("stats.json")});
  ASSERT_EQ(r.status, 0) << r.error;
  const ImageFile file = readImageFile(path("out.exr"));
  const Image composite = *findColor(file), plate = readImage(path("plate.exr"));
  ASSERT_EQ(composite.width, 32);  // the plate's size
  const Image alpha = alphaOf(file), difference = *findLayer(file, "difference");
  const Image with = *findLayer(file, "l_obj"), without = *findLayer(file, "l_noobj");
  int objects = 0, shaded = 0, untouched = 0;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 32; ++x) {
      const Rgb c = composite.rgb(x, y), p = plate.rgb(x, y), d = difference.rgb(x, y);
      const float a = *alpha.at(x, y);
      objects += a > 0;
      if (a == 1) {
        EXPECT_LT(glm::length(c - with.rgb(x, y)), 1e-5f);
      }
      if (a > 0) continue;
      EXPECT_LT(glm::length(d - (with.rgb(x, y) - without.rgb(x, y))), 1e-5f);
      EXPECT_LT(glm::length(c - glm::max(p + d, 0.0f)), 1e-5f);
      if (d == Rgb(0)) {
        EXPECT_EQ(c, p);
        ++untouched;
      }
      shaded += luminance(d) < 0;
    }
  EXPECT_GT(objects, 2);
  EXPECT_GT(shaded, 10);
  EXPECT_GT(untouched, 100);  // beside the ground
  const auto stats = jsonOfFile(path("stats.json"));
  EXPECT_GT(stats["composite"]["objects"], 0);
}

TEST_F(SlowCommandComposite, TwoPassesAndRatioGiveSimilarImages) {
  ASSERT_EQ(render(scene(kGood), {"--samples", "64"}).status, 0);
  const Image one = readImage(path("out.exr"));
  ASSERT_EQ(render(scene(kGood), {"--samples", "64", "--two-pass"}).status, 0);
  const Image two = readImage(path("out.exr"));
  double sum = 0;
  for (size_t i = 0; i < one.texels.size(); ++i) sum += std::abs(one.texels[i] - two.texels[i]);
  EXPECT_LT(sum / double(one.texels.size()), 0.02);
  EXPECT_GT(sum, 0);
  ASSERT_EQ(render(scene(std::string(kGood) + "\nmode = \"ratio\""), {}).status, 0);
}

// An 8-bit plate is decoded from sRGB; where nothing changed, the output has the same codes.
TEST_F(CommandComposite, PlatesOfEightBitsArePreserved) {
  writePlate(path("plate.png"), 32, 16);
  const CommandResult r = render(scene("plate = \"plate.png\"\nlocal_scene = \"ground\""),
                                 {"-o", path("out.png"), "--aov", "difference,alpha"});
  ASSERT_EQ(r.status, 0) << r.error;
  EXPECT_NE(r.error.find("sRGB"), std::string::npos) << r.error;
  const ImageFile file = readImageFile(path("out.exr"));
  const Image difference = *findLayer(file, "difference"), alpha = alphaOf(file);
  const Image plate = readImage(path("plate.png")), png = readImage(path("out.png"));
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 32; ++x)
      if (difference.rgb(x, y) == Rgb(0) && *alpha.at(x, y) == 0) {
        EXPECT_EQ(png.rgb(x, y), plate.rgb(x, y));
      }
}

TEST_F(CommandComposite, PlatesAreScaledToTheRenderSize) {
  ASSERT_EQ(render(scene(kGood), {"--size", "16x8", "--aov", "difference,alpha"}).status, 0);
  const ImageFile file = readImageFile(path("out.exr"));
  const Image small = *findColor(file), plate = readImage(path("plate.exr"));
  ASSERT_EQ(small.width, 16);
  const Image difference = *findLayer(file, "difference"), alpha = alphaOf(file);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x) {
      if (difference.rgb(x, y) != Rgb(0) || *alpha.at(x, y) > 0) continue;
      Rgb mean(0);
      for (int i = 0; i < 4; ++i) mean += plate.rgb(2 * x + i % 2, 2 * y + i / 2) / 4.0f;
      EXPECT_LT(glm::length(small.rgb(x, y) - mean), 1e-6f);
    }
  expectError({"render", scene(kGood), "-o", path("x.exr"), "--size", "16x9"},
              "plate.exr: the plate has 32x16 pixels, but the image size is 16x9");
}

// A node in `local_scene` includes its descendants.
TEST_F(CommandComposite, LocalNodesIncludeTheirDescendants) {
  expectInputError(scene("plate = \"plate.exr\"\nlocal_scene = [\"ground\", \"boat\"]"),
                   "every node is part of the local scene");
}

// A name of the local scene may be that of an empty or hidden node.
TEST_F(CommandComposite, WarnsOfALocalSceneWithoutSurfaces) {
  const int pier = model_.add("nodes", {{"name", "pier"}});
  model_.root["scenes"] = {{{"nodes", {0, 2, pier}}}};
  model_.save();
  const auto warning = [&](const std::string& local) {
    return render(scene("plate = \"plate.exr\"\nlocal_scene = \"" + local + "\""), {}).error;
  };
  EXPECT_NE(warning("pier").find("`pier`, the local scene, has no visible surface"),
            std::string::npos)
      << warning("pier");
  EXPECT_EQ(warning("ground").find("has no visible surface"), std::string::npos);
}

TEST_F(SlowCommandComposite, RejectsInvalidInput) {
  expectInputError(scene("plate = \"plate.exr\"\nlocal_scene = [\"grund\"]"),
                   "scene.toml:11: the model has no node `grund`; did you mean `ground`?");
  expectInputError(scene("plate = \"none.exr\"\nlocal_scene = \"ground\""), "no such file");
  expectInputError(scene("plate = \"plate.exr\""), "[composite] has no `local_scene`");
  expectInputError(scene("local_scene = \"ground\""), "[composite] has no `plate`");
  expectInputError(scene(std::string(kGood) + "\nmode = \"rato\""), "did you mean `ratio`?");
  expectInputError(scene(std::string(kGood) + "\nmod = \"ratio\""), "did you mean `mode`?");
  expectInputError(scene("plate = \"scene.toml\"\nlocal_scene = \"ground\""), "scene.toml");
  Image plate(32, 16, 3);
  plate.setRgb(5, 4, Rgb(NAN));
  plate.setRgb(7, 9, Rgb(INFINITY));
  writeImage(path("plate.exr"), plate);
  expectInputError(scene(kGood),
                   "plate.exr: 2 pixels of the plate are NaN or infinite, the first at (5, 4)");
  expectError({"render", path("model.gltf"), "--probe", path("probe.hdr"), "-o", path("out.exr"),
               "--aov", "l_obj"},
              "--aov: layer `l_obj` is a composite's");
  expectError({"render", path("model.gltf"), "--probe", path("probe.hdr"), "-o", path("out.exr"),
               "--two-pass"},
              "--two-pass");
}

TEST_F(SlowCommandComposite, EstimatesReflectanceFromThePlate) {
  for (const char* how : {"plate", "flat"}) {
    const std::string lines = std::string(kGood) + "\nreflectance = \"" + how + "\"";
    const CommandResult r =
        render(scene(lines), {"--aov", "reflectance,l_noobj,difference,alpha", "--samples", "256",
                              "--probe-scale", "3", "--stats", path("stats.json")});
    ASSERT_EQ(r.status, 0) << r.error;
    const ImageFile file = readImageFile(path("out.exr"));
    const Image reflectance = *findLayer(file, "reflectance"), alone = *findLayer(file, "l_noobj");
    const Image plate = readImage(path("plate.exr"));
    double error = 0;
    int known = 0;
    for (int y = 4; y < 12; ++y)
      for (int x = 10; x < 22; ++x)
        if (const Rgb rho = reflectance.rgb(x, y); maxComponent(rho) < 1) {
          error += glm::length(alone.rgb(x, y) - plate.rgb(x, y));
          ++known;
        }
    EXPECT_GT(known, 50);
    EXPECT_LT(error / known, 0.05) << how;
    const auto stats = jsonOfFile(path("stats.json"));
    EXPECT_GT(stats["reflectance"]["pixels"], 50);
  }
  // With a probe this dark, the plate needs an albedo above 1.
  const CommandResult dark =
      render(scene(std::string(kGood) + "\nreflectance = \"plate\""), {"--probe-scale", "0.2"});
  EXPECT_NE(dark.error.find("plate and probe may differ in exposure: the light fits the plate at "),
            std::string::npos)
      << dark.error;
  EXPECT_NE(dark.error.find(" times its brightness; try --probe-scale "), std::string::npos)
      << dark.error;

  expectInputError(scene(std::string(kGood) + "\nreflectance = \"plat\""), "did you mean `plate`?");
  expectInputError(scene(std::string(kGood) + "\nspecular = 2"),
                   "`specular` must be a number from 0 to 1");
  expectInputError(scene(std::string(kGood) + "\nreflectance = \"flat\"\niterations = 2"),
                   "`iterations` is only for reflectance = \"plate\"");
  expectInputError(scene("plate = \"plate.exr\"\nlocal_scene = []"),
                   "`local_scene` must name at least one node");
  expectError({"render", scene(kGood), "-o", path("x.exr"), "--transparent"},
              "--transparent: is for plain renders; the layer alpha of a composite");
  expectError({"render", scene(kGood), "-o", path("x.exr"), "--aov", "reflectance"},
              "--aov: layer `reflectance` needs reflectance =");
  expectError({"render", path("model.gltf"), "--probe", path("probe.hdr"), "-o", path("x.exr"),
               "--shadow-catcher", "ground", "--aov", "reflectance"},
              "--aov: a shadow catcher has no plate");
  expectError({"render", path("model.gltf"), "--probe", path("probe.hdr"), "-o", path("x.exr"),
               "--shadow-catcher", "grund"},
              "--shadow-catcher: the model has no node `grund`");
}

TEST_F(SlowCommandComposite, SurroundingsMustContainTheModel) {
  const std::string room = "[surroundings]\nshape = \"box\"\nmin = [-2, 0, -2]\n";
  ASSERT_EQ(render(scene(kGood, room + "max = [2, 5, 2]"), {}).status, 0);
  expectInputError(scene(kGood, room + "max = [0.5, 5, 2]"),
                   "the model must lie inside [surroundings]");
  expectInputError(scene(kGood, room + "max = [-3, 5, 2]"), "`max` must be above `min`");
  expectInputError(scene(kGood, room + "max = [2, 5, 2]\ncapture = [0, 6, 0]"), "lies outside");
  expectInputError(scene(kGood, "[surroundings]\nshape = \"cone\""),
                   "`shape`: `cone` is not known");
  expectInputError(scene(kGood, "[surroundings]\nshape = \"sphere\"\ncenter = [0, 0, 0]"),
                   "has no `radius`");
  expectInputError(
      scene(kGood, "[surroundings]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nmin = [0, 0, 0]"),
      "a sphere has no `min`; it has shape, center, radius, capture");
  std::ofstream(path("lamp.toml")) << "model = 'model.gltf'\n[[light]]\ndirection = [0, 1, 0]\n"
                                   << "irradiance = 1\n"
                                   << room << "max = [2, 5, 2]\n";
  expectInputError(path("lamp.toml"), "lamp.toml:5: [surroundings] needs a probe");
}

TEST_F(SlowCommandComposite, SurroundingsMayBeAModel) {
  const std::string room = "[surroundings]\nshape = \"model\"\nfile = \"model.gltf\"\n";
  ASSERT_EQ(render(scene(kGood, room + "capture = [0, 0.25, 0]"), {}).status, 0);
  expectInputError(scene(kGood, room), "has no `capture`");
  expectInputError(scene(kGood, room + "capture = [0, 50, 0]"), "lies outside the room");
  expectInputError(scene(kGood, "[surroundings]\nshape = \"model\"\nfile = \"hall.glb\""),
                   "hall.glb");
}

// A photograph taken with a phone, and a probe captured at the same location.
TEST_F(SlowCommandComposite, ARealPhotographAsPlate) {
  const std::string folder = "reference/differential_rendering/kartikagrawal27/";
  const auto plate = sharedData(folder + "Materials/empty.jpg");
  const auto probe = sharedData(folder + "flattened.hdr");
  if (!plate || !probe) GTEST_SKIP() << folder << " is absent";
  std::filesystem::create_symlink(*plate, path("photo.jpg"));
  const CommandResult r = render(scene("plate = \"photo.jpg\"\nlocal_scene = \"ground\""),
                                 {"--probe", *probe, "--samples", "2", "--size", "408x306",
                                  "--probe-scale", "0.05", "--aov", "difference,alpha"});
  ASSERT_EQ(r.status, 0) << r.error;
  const ImageFile file = readImageFile(path("out.exr"));
  const Image composite = *findColor(file), photo = scaledPlate(readPlate(*plate), 408, 306, "");
  const Image difference = *findLayer(file, "difference"), alpha = alphaOf(file);
  ASSERT_EQ(composite.width, photo.width);
  size_t untouched = 0;
  for (int y = 0; y < photo.height; ++y)
    for (int x = 0; x < photo.width; ++x)
      if (difference.rgb(x, y) == Rgb(0) && *alpha.at(x, y) == 0) {
        ASSERT_EQ(composite.rgb(x, y), photo.rgb(x, y));
        ++untouched;
      }
  EXPECT_GT(untouched, photo.texels.size() / 9);
}

}  // namespace
}  // namespace chromeball::command_composite_test
