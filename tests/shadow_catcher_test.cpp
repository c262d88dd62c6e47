// SPDX-License-Identifier: Apache-2.0
// Objects and their shadows to be laid over a photograph: --shadow-catcher, [composite] without a
// plate.
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <fstream>

#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "probe/synth.h"
#include "run_command.h"
#include "test_scene.h"

namespace chromeball::shadow_catcher_test {
namespace {

using Strings = std::vector<std::string>;

constexpr const char* kBelow =  // the camera looks under the object at the floor
    "[camera]\nposition = [0.3, -1.5, 0.6]\nlook_at = [0.3, 0.3, 0]\nfov = 3\n";
constexpr const char* kBoth =
    "[camera]\nposition = [0.5, -1.2, 3.2]\nlook_at = [0.4, 0.4, 0.6]\nfov = 36\n";

// A white floor, z = 0, under a triangle at z = 1.
class FloorAndObject {
 public:
  explicit FloorAndObject(const std::vector<double>& objectColor) {
    const auto matte = [](const std::vector<double>& color) {
      return nlohmann::json{
          {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorFactor", color}}},
          {"doubleSided", true},
          {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}};
    };
    writer_.add("materials", matte({0.8, 0.6, 0.4, 1}));
    writer_.add("materials", matte(objectColor));
    addTriangle(writer_, {{"material", 0}},
                {{"name", "floor"}, {"translation", {-20, -20, 0}}, {"scale", {80, 80, 1}}});
    addTriangle(writer_, {{"material", 1}}, {{"name", "object"}, {"translation", {0, 0, 1}}});
    writer_.save();
  }
  std::string operator/(const std::string& name) const { return writer_.folder() / name; }
  ImageFile render(const std::string& scene, Strings options) const {
    std::ofstream(*this / "a.toml") << "model = 'model.gltf'\n" << scene;
    Strings command{"render", *this / "a.toml", "-o", *this / "o.exr", "--size", "12x8"};
    command.insert(command.end(), options.begin(), options.end());
    const CommandResult result = runCommand(command);
    EXPECT_EQ(result.status, 0) << result.error << fmt::format("{}", command);
    return readImageFile(*this / "o.exr");
  }

 private:
  GltfWriter writer_;
};

// Light from above, which the black object blocks, and from the side, which it does not.
std::string twoSuns(const std::string& above, const std::string& side) {
  return "[[light]]\ndirection = [0, 0, 1]\nangle = 0.01\nirradiance = " + above +
         "\n[[light]]\ndirection = [0.8, 0, 0.6]\nangle = 0.01\nirradiance = " + side + "\n";
}

// Alpha is the share of the light that is blocked: E1 / (E1 + E2 cos).
TEST(ShadowCatcher, AlphaIsTheShareOfTheLightThatIsBlocked) {
  const FloorAndObject scene({0, 0, 0, 1});
  const ImageFile file =
      scene.render(kBelow + twoSuns("2", "3"), {"--shadow-catcher", "floor", "--samples", "64"});
  const Image color = *findColorAndAlpha(file);
  ASSERT_EQ(color.channels, 4);
  const Image ratio = *findLayer(file, "ratio");
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x) {
      EXPECT_NEAR(color.at(x, y)[3], 2 / (2 + 3 * 0.6), 1e-3);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(color.at(x, y)[c], 0, 1e-3);
      EXPECT_NEAR(ratio.rgb(x, y).x, 1.8 / 3.8, 1e-3);
    }
}

// A shadow of coloured light: alpha is the darkest channel's; the colour has the rest.
TEST(ShadowCatcher, AShadowMayBeColoured) {
  const FloorAndObject scene({0, 0, 0, 1});
  const ImageFile file = scene.render(kBelow + twoSuns("[2, 1, 0]", "3"),
                                      {"--shadow-catcher", "floor", "--samples", "64"});
  const Image color = *findColorAndAlpha(file);
  const double darkest = 1.8 / 3.8;
  EXPECT_NEAR(color.at(5, 4)[3], 1 - darkest, 1e-3);
  const double albedo[] = {0.8, 0.6, 0.4}, lit[] = {3.8, 2.8, 1.8};
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(color.at(5, 4)[c], albedo[c] / kPiD * (1.8 - darkest * lit[c]), 1e-3);
}

// Laid over the floor without the object, the image is the floor with it; also the light that the
// object reflects onto the floor, and where it covers part of a pixel.
TEST(ShadowCatcher, OverTheLocalSceneItIsTheWholeScene) {
  const FloorAndObject scene({0.1, 0.3, 0.9, 1});
  writeImage(scene / "p.exr", gradientProbe({64, 32}, Rgb(0.4f, 0.5f, 0.7f), {0.2, 0.3, 0.9}));
  const std::string text = std::string(kBoth) + "[probe]\nfile = 'p.exr'\n";
  for (const Strings& options : {Strings{}, Strings{"--strategy", "median-cut:16"}}) {
    Strings all{"--samples", "64", "--aov", "l_obj,l_noobj", "--shadow-catcher", "floor"};
    all.insert(all.end(), options.begin(), options.end());
    const ImageFile file = scene.render(text, all);
    Image color = *findColorAndAlpha(file);
    const Image with = *findLayer(file, "l_obj"), without = *findLayer(file, "l_noobj");
    const Image alpha = *findLayer(file, "alpha"), objects = *findLayer(file, "objects");
    const Image difference = *findLayer(file, "difference"), ratio = *findLayer(file, "ratio");
    int partly = 0, shaded = 0, covered = 0;
    for (int y = 0; y < color.height; ++y)
      for (int x = 0; x < color.width; ++x) {
        const float own = *alpha.at(x, y), kept = 1 - color.at(x, y)[3];
        EXPECT_GE(kept, 0);
        EXPECT_GE(1 - kept, own - 1e-6f);
        partly += own > 0 && own < 1, covered += own == 1, shaded += own == 0 && kept < 0.99f;
        for (int c = 0; c < 3; ++c) {
          EXPECT_GE(color.at(x, y)[c], 0);
          const float behind = without.rgb(x, y)[c], whole = with.rgb(x, y)[c];
          // Objects plus the floor by either formula: exact where no object is seen first.
          if (own == 0) {
            EXPECT_NEAR(color.at(x, y)[c] + kept * behind, whole, 1e-5f * (1 + whole));
            EXPECT_NEAR(behind * ratio.rgb(x, y)[c], whole, 1e-5f * (1 + whole));
          }
          if (own == 1) {
            EXPECT_NEAR(color.at(x, y)[c], whole, 1e-5f * (1 + whole));
            EXPECT_EQ(kept, 0);
          }
          // l_noobj is the whole pixel's; beside an object it differs by the floor's gradient and
          // by noise, at most a tenth of its radiance, 0.5.
          const float sum = objects.rgb(x, y)[c] + (1 - own) * behind + difference.rgb(x, y)[c];
          EXPECT_NEAR(sum, whole, own > 0 && own < 1 ? 0.05f : 1e-5f * (1 + whole));
        }
      }
    EXPECT_GT(partly, 3);
    EXPECT_GT(covered, 0);
    EXPECT_GT(shaded, 10);
  }
}

// The layers are not denoised, the image is: over the noisy floor it stays near to it.
TEST(ShadowCatcher, Denoised) {
  const FloorAndObject scene({0.1, 0.3, 0.9, 1});
  writeImage(scene / "p.exr", gradientProbe({64, 32}, Rgb(0.4f, 0.5f, 0.7f), {0.2, 0.3, 0.9}));
  const ImageFile file = scene.render(
      std::string(kBoth) + "[probe]\nfile = 'p.exr'\n",
      {"--samples", "64", "--aov", "l_obj,l_noobj", "--shadow-catcher", "floor", "--denoise"});
  const Image color = *findColorAndAlpha(file), behind = *findLayer(file, "l_noobj");
  ASSERT_EQ(color.channels, 4);
  double over = 0;
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x) {
      const float* pixel = color.at(x, y);
      EXPECT_GE(std::min({pixel[0], pixel[1], pixel[2], pixel[3]}), 0);
      EXPECT_LE(pixel[3], 1);
      over += pixel[1] + (1 - pixel[3]) * behind.rgb(x, y).y;
    }
  const double whole = meanColor(*findLayer(file, "l_obj")).y * color.width * color.height;
  EXPECT_NEAR(over / whole, 1,
              0.05);  // the noise of 64 samples in 96 pixels, and partly covered ones
}

// Without noise and with grey light it is the composite of the ratio, over any plate.
TEST(ShadowCatcher, OverAPlateItIsTheCompositeOfTheRatio) {
  const FloorAndObject scene({0, 0, 0, 1});
  Image plate(12, 8, 3);
  for (size_t i = 0; i < plate.texels.size(); ++i) plate.texels[i] = 0.1f + 0.01f * float(i % 37);
  writeImage(scene / "plate.exr", plate);
  const std::string text = std::string(kBoth) + twoSuns("2", "3");
  const Strings samples{"--samples", "256", "--adaptive", "off"};
  const Image caught = *findColorAndAlpha(scene.render(
      text + "[composite]\nmode = 'shadow-catcher'\nlocal_scene = 'floor'\n", samples));
  const Image composite = *findColor(scene.render(
      text + "[composite]\nmode = 'ratio'\nlocal_scene = 'floor'\nplate = 'plate.exr'\n", samples));
  for (int y = 0; y < plate.height; ++y)
    for (int x = 0; x < plate.width; ++x)
      for (int c = 0; c < 3; ++c) {
        const float* over = caught.at(x, y);
        // Where the floor has another albedo per channel, all channels have the least ratio.
        EXPECT_NEAR(over[c] + (1 - over[3]) * plate.rgb(x, y)[c], composite.rgb(x, y)[c], 2e-3)
            << x << " " << y;
      }
}

// Parts put together, and an image with a ground that nobody modelled.
TEST(ShadowCatcher, SurvivesCropsAndNeedsNoFloor) {
  const FloorAndObject scene({0.5, 0.5, 0.5, 1});
  const std::string text = std::string(kBoth) + twoSuns("2", "3");
  const Strings options{"--shadow-catcher", "floor", "--samples", "16", "--adaptive", "off"};
  const auto with = [&](const std::string& crop) {
    Strings all = options;
    all.insert(all.end(), {"--crop", crop});
    return all;
  };
  const ImageFile whole = scene.render(text, options);
  for (const auto& [name, crop] :
       {std::pair{"1.exr", "0,0,12,3"}, std::pair{"2.exr", "0,3,12,5"}}) {
    scene.render(text, with(crop));
    ASSERT_EQ(std::rename((scene / "o.exr").c_str(), (scene / name).c_str()), 0);
  }
  ASSERT_EQ(runCommand({"merge", scene / "1.exr", scene / "2.exr", "-o", scene / "m.exr"}).status,
            0);
  EXPECT_EQ(readImageFile(scene / "m.exr").image.texels, whole.image.texels);

  const ImageFile ground = scene.render(
      "[camera]\nposition = [0.5, 0.6, 4]\nlook_at = [0.5, 0.3, 0]\nfov = 50\n[[light]]\n"
      "direction = [0.3, 1, 0.3]\nirradiance = 2\n",
      {"--shadow-catcher", "ground", "--samples", "16", "-o", scene / "o.png"});
  EXPECT_EQ(findColorAndAlpha(ground)->channels, 4);
}

TEST(ShadowCatcher, RefusesWhatItCannotDo) {
  const FloorAndObject scene({0.5, 0.5, 0.5, 1});
  writeImage(scene / "plate.exr", Image(12, 8, 3));
  const auto refused = [&](const std::string& text, Strings options, const std::string& reason) {
    std::ofstream(scene / "a.toml") << "model = 'model.gltf'\n" << twoSuns("1", "1") << text;
    Strings command{"render", scene / "a.toml", "-o", scene / "o.exr"};
    command.insert(command.end(), options.begin(), options.end());
    expectError(command, reason);
  };
  refused("", {"--shadow-catcher", "flor"}, "`flor`");
  refused("", {"--shadow-catcher", ""}, "--shadow-catcher");
  refused("", {"--shadow-catcher", "floor,object"}, "no objects are left");
  refused("", {"--shadow-catcher", "floor", "--two-pass"}, "plate");
  refused("", {"--shadow-catcher", "floor", "--transparent"}, "plain renders");
  refused("", {"--shadow-catcher", "floor", "--aov", "light_groups"}, "light_groups");
  const std::string composite = "[composite]\nlocal_scene = 'floor'\nplate = 'plate.exr'\n";
  refused(composite, {"--shadow-catcher", "floor"}, "has [composite]");
  refused(composite + "mode = 'shadow-catcher'\n", {}, "without `plate`");
  const std::string catcher = "[composite]\nlocal_scene = 'floor'\nmode = 'shadow-catcher'\n";
  refused(catcher + "reflectance = 'plate'\n", {}, "no plate");
  refused("[composite]\nlocal_scene = 'floor'\n", {}, "plate");
}

}  // namespace
}  // namespace chromeball::shadow_catcher_test
