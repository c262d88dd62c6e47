// SPDX-License-Identifier: Apache-2.0
// Posed tiles to a probe: the place comes back, with the tiles' gains and poses.
#include "probe/capture/stitch.h"
#include "base/json.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "image/image.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "instrumented.h"
#include "math/icosphere.h"
#include "probe/irradiance.h"
#include "probe/load.h"
#include "probe/probe.h"
#include "probe/synth.h"
#include "run_command.h"
#include "shared_data.h"
#include "sphere_test.h"

namespace chromeball::stitch_test {
namespace {

using glm::dquat;
using glm::dvec3;

// A pinhole photograph: pixels are means of 3 x 3 points.
Tile photograph(const Probe& place, const Rotation& pose, double fov, int width, int height) {
  constexpr int kSamples = 3;
  Tile tile{"tile", Image(width, height, 3), pose, fov};
  const double tangent = std::tan(glm::radians(fov) / 2), pixel = 2 * tangent / height;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      dvec3 sum(0);
      for (int k = 0; k < kSamples * kSamples; ++k) {
        const double px = (x + (k % kSamples + 0.5) / kSamples - 0.5 * width) * pixel;
        const double py = (y + (k / kSamples + 0.5) / kSamples - 0.5 * height) * pixel;
        const dvec3 d = pose(glm::normalize(dvec3(px, -py, -1)));
        sum += dvec3(place.radiance(vec3(d)));
      }
      tile.image.setRgb(x, y, Rgb(sum / double(kSamples * kSamples)));
    }
  return tile;
}

// Two rows of nine upright tiles, 64 degrees wide and 96 high: together they see all.
std::vector<Tile> photographs(const Probe& place, int width = 100) {
  constexpr double kFov = 96;
  const double aspect = std::tan(glm::radians(32.)) / std::tan(glm::radians(kFov / 2));
  std::vector<Tile> tiles;
  for (int row = 0; row < 2; ++row)
    for (int i = 0; i < 9; ++i)
      tiles.push_back(photograph(place,
                                 Rotation::ofAngles({40. * i + 20 * row, row ? 43. : -43., 1. * i}),
                                 kFov, width, int(std::lround(width / aspect))));
  return tiles;
}

Image uffizi() {
  const auto file = sharedData("probes/probulator/uffizi_latlong_small.hdr");
  return file ? loadProbe(*file).latLong : Image();
}

Image studio() {
  Image map = studioProbe({256, 128});
  const Image slope = gradientProbe({256, 128}, Rgb(0.2f, 0.3f, 0.4f), {0.5, 0.3, -0.6});
  for (size_t i = 0; i < map.texels.size(); ++i) map.texels[i] += slope.texels[i];
  return map;
}

TEST(SlowStitch, TilesOfAPlaceGiveItBack) {
  const Image map = uffizi();
  if (map.empty()) GTEST_SKIP();
  const std::vector<Tile> tiles = photographs(Probe(map), 300);
  const StitchedProbe stitched = stitch(tiles, std::vector<double>(tiles.size(), 1.0), {512, 256});
  EXPECT_LT(stitched.uncovered, 1e-9);
  // The content of the photographs: the interpolation of the map's texels.
  const Probe place(map);
  Image fine(2048, 1024, 3);
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < fine.width; ++x)
      fine.setRgb(x, y, place.radiance(vec3(texelDirection({2048, 1024}, x, y))));
  const std::vector<vec3> normals = icosphereNormals(2);
  const auto expected = exactIrradiance(fine, normals),
             seen = exactIrradiance(stitched.latLong, normals);
  for (size_t i = 0; i < normals.size(); ++i)
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(seen[i][k] / expected[i][k], 1, 1e-3);
  const Image texels = resampled(fine, 512, 256);  // means, like the stitched probe's
  std::vector<float> differences;
  for (int y = 0; y < texels.height; ++y)
    for (int x = 0; x < texels.width; ++x) {
      const float was = luminance(texels.rgb(x, y)), is = luminance(stitched.latLong.rgb(x, y));
      differences.push_back(std::fabs(is - was) / std::max(was, 0.05f));
    }
  const auto middle = differences.begin() + std::ptrdiff_t(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  EXPECT_LT(*middle, 0.01f);
}

TEST(Stitch, DirectionsThatNoTileSeesAreCounted) {
  const Probe place(constantProbe({16, 8}, Rgb(2)));
  const std::vector<Tile> tiles{photograph(place, Rotation(), 90, 50, 50)};
  const StitchedProbe stitched = stitch(tiles, {1.0}, {256, 128});
  EXPECT_NEAR(stitched.uncovered, 5. / 6, 2e-3) << "one face of a cube is seen";
  EXPECT_EQ(stitched.latLong.rgb(128, 64), Rgb(2));
  EXPECT_EQ(stitched.latLong.rgb(0, 64), Rgb(0));
  EXPECT_EQ(stitchedSize(tiles).height, 80) << "pi / (2 tan(45 degrees) / 50)";
  const std::vector<Tile> fine{{"tile", Image(64, 64, 3), Rotation(), 0.01}};
  EXPECT_EQ(stitchedSize(fine).height, 8192);
}

TEST(SlowStitch, GainsAreFoundUpToACommonOne) {
  std::vector<Tile> tiles = photographs(Probe(studio()), 60);
  std::vector<double> expected;
  double sum = 0;
  for (size_t i = 0; i < tiles.size(); ++i) {
    expected.push_back(std::exp(0.3 * (double(random1(int(i), 0)) - 0.5)));
    sum += std::log(expected.back());
    for (float& channel : tiles[i].image.texels) channel /= float(expected.back());
  }
  const std::vector<double> gains = tileGains(tiles);
  for (size_t i = 0; i < tiles.size(); ++i)
    EXPECT_NEAR(gains[i] / (expected[i] / std::exp(sum / double(tiles.size()))), 1, 2e-3);
}

TEST(SlowStitch, DisturbedPosesAreRecovered) {
  const Image map = uffizi();
  if (map.empty()) GTEST_SKIP();  // a made one has too few features
  std::vector<Tile> tiles = photographs(Probe(map), 160);
  std::vector<Rotation> expected;
  for (size_t i = 0; i < tiles.size(); ++i) {
    expected.push_back(tiles[i].pose);
    if (i == 0) continue;
    const vec3 axis = squareToUniformSphere(random2(int(i), 0));
    tiles[i].pose = Rotation::ofQuaternion(glm::angleAxis(glm::radians(0.3), dvec3(axis)) *
                                           tiles[i].pose.quaternion());
  }
  const PoseRefinement refinement = refinePoses(tiles);
  EXPECT_LT(refinement.after, 0.5 * refinement.before);
  EXPECT_EQ(refinement.turns[0], 0);
  for (size_t i = 0; i < tiles.size(); ++i) {
    const double cosine = std::fabs(glm::dot(tiles[i].pose.quaternion(), expected[i].quaternion()));
    EXPECT_LT(glm::degrees(2 * std::acos(std::min(cosine, 1.0))), 0.02) << i;
  }
}

TEST(Stitch, TilesThatDoNotOverlapAreRefused) {
  const Probe place(constantProbe({16, 8}, Rgb(2)));
  std::vector<Tile> tiles{photograph(place, Rotation(), 40, 20, 20),
                          photograph(place, Rotation(30), 40, 20, 20),
                          photograph(place, Rotation(170), 40, 20, 20)};
  tiles[0].name = "a.exr", tiles[2].name = "c.exr";
  try {
    tileGains(tiles);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "c.exr: is not connected to a.exr by tiles that overlap");
  }
  tiles.pop_back();
  EXPECT_THROW(refinePoses(tiles), InputError) << "a constant place determines no pose";
}

TEST(Stitch, ASingleTileHasNoPoseToRefine) {
  const Probe place(gradientProbe({64, 32}, Rgb(1), {0.5, 0.3, -0.6}));
  std::vector<Tile> tiles{photograph(place, Rotation(30), 50, 100, 100)};
  const PoseRefinement refinement = refinePoses(tiles);
  EXPECT_EQ(refinement.turns, std::vector<double>{0});
  EXPECT_EQ(refinement.before, 0);
  EXPECT_EQ(refinement.after, 0);
  EXPECT_EQ(tiles[0].pose, Rotation(30));
}

class CommandStitch : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_ / name; }
  std::string list(const std::string& toml) const {
    std::ofstream(path("tiles.toml")) << toml;
    return path("tiles.toml");
  }
  void refuse(const std::string& toml, const std::string& reason) const {
    expectError({"probe", "stitch", list(toml), "-o", path("out.exr")}, reason);
  }

  const TemporaryFolder folder_;
};

TEST_F(CommandStitch, ReadsAListAndWritesRefinedPoses) {
  const Probe place(studio());
  std::string toml = "fov = 100\n";
  for (int i = 0; i < 6; ++i) {
    const Rotation::Angles pose{90. * i, i == 4 ? 90. : i == 5 ? -90. : 0., 0};
    const std::string name = fmt::format("t{}.exr", i);
    writeImage(path(name), photograph(place, Rotation::ofAngles(pose), 100, 64, 64).image);
    toml += "[[tile]]\nfile = '" + name + "'\nyaw = " + std::to_string(pose.yaw + (i == 2)) +
            "\npitch = " + std::to_string(pose.pitch) + "\n";
  }
  const CommandResult plain =
      runCommand({"probe", "stitch", list(toml), "-o", path("out.exr"), "--size", "64x32"});
  EXPECT_EQ(plain.status, 0) << plain.error;
  EXPECT_EQ(plain.error, "") << "nothing is uncovered";
  EXPECT_NE(plain.out.find("t5.exr  gain "), std::string::npos) << plain.out;
  const CommandResult refined =
      runCommand({"probe", "stitch", path("tiles.toml"), "-o", path("out.exr"), "--size", "64x32",
                  "--refine", "--poses", path("poses.toml"), "--same-exposure"});
  EXPECT_EQ(refined.status, 0) << refined.error;
  const size_t yaw = refined.out.find("t2.exr  yaw ");
  ASSERT_NE(yaw, std::string::npos) << refined.out;
  constexpr double kPixel = 100.0 / 64;  // degrees
  EXPECT_NEAR(std::abs(std::stod(refined.out.substr(yaw + 12))), 180, 0.2 * kPixel);
  const CommandResult again = runCommand({"probe", "stitch", path("poses.toml"), "-o",
                                          path("again.exr"), "--size", "64x32", "--same-exposure"});
  EXPECT_EQ(again.status, 0) << again.error;
  // The list names its tiles from its own folder.
  std::filesystem::create_directory(path("lists"));
  const CommandResult elsewhere =
      runCommand({"probe", "stitch", path("tiles.toml"), "-o", path("out2.exr"), "--size", "64x32",
                  "--refine", "--poses", path("lists/../lists/poses.toml"), "--same-exposure"});
  EXPECT_EQ(elsewhere.status, 0) << elsewhere.error;
  EXPECT_NE(fileContents(path("lists/poses.toml")).find("'../t0.exr'"), std::string::npos);
  const Image a = readImage(path("out.exr")), b = readImage(path("again.exr"));
  for (size_t i = 0; i < a.texels.size(); ++i) ASSERT_NEAR(a.texels[i], b.texels[i], 1e-4f);
}

TEST_F(CommandStitch, ChecksTheMemoryOfItsOwnSize) {
  if (kIsInstrumented) GTEST_SKIP() << kMeasuresMemory;
  writeImage(path("n.exr"), Image(16, 16, 3));
  const CommandResult result =
      runExecutable({"probe", "stitch", list("fov = 0.01\n[[tile]]\nfile = 'n.exr'\nyaw = 0\n"),
                     "-o", path("out.exr")},
                    "", SIGINT, {.memory = size_t(4) << 30});
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.error.find("16384 x 8192 texels with 3 channels take"), std::string::npos)
      << result.error;
}

TEST_F(CommandStitch, RefinesASingleTileToItself) {
  const Probe place(studio());
  writeImage(path("n.exr"), photograph(place, Rotation(), 50, 32, 32).image);
  const std::string tile = list("fov = 50\n[[tile]]\nfile = 'n.exr'\nyaw = 0\n");
  std::vector<std::string> words{"probe", "stitch", tile, "-o", path("plain.exr")};
  ASSERT_EQ(runCommand(words).status, 0);
  words.back() = path("refined.exr");
  words.push_back("--refine");
  const CommandResult refined = runCommand(words);
  ASSERT_EQ(refined.status, 0) << refined.error;
  EXPECT_EQ(refined.out.find("overlaps"), std::string::npos) << refined.out;
  EXPECT_EQ(readImage(path("plain.exr")).texels, readImage(path("refined.exr")).texels);
}

TEST_F(CommandStitch, WrongListsAreExplained) {
  writeImage(path("a.exr"), constantProbe({8, 8}, Rgb(1)));
  refuse("", "tiles.toml: has no [[tile]]");
  refuse("tile = 3\n", "tiles.toml: has no [[tile]]");
  refuse("tile = [3]\n", "tiles.toml:1: `tile` must be a table, [[tile]]");
  refuse("[[tile]]\nfile = 'a.exr'\n", "tiles.toml:1: [[tile]] needs `fov`");
  refuse("fov = 50\n[[tile]]\nyaw = 3\n", "tiles.toml:2: [[tile]] needs `file`");
  refuse("fov = 50\n[[tile]]\nfile = 'b.exr'\n", "b.exr: no such file (paths are relative");
  refuse("fov = 50\n[[tile]]\nfile = \"a.exr\\u0000b\"\n",
         "tiles.toml:3: `file` must be a string without U+0000");
  refuse("fov = 180\n[[tile]]\nfile = 'a.exr'\n",
         "tiles.toml:1: `fov` must be a number of degrees from 0.01 to 179");
  refuse("fov = 50\n[[tile]]\nfile = 'a.exr'\nyaw = 'left'\n",
         "tiles.toml:4: `yaw` must be a number of degrees from -3600 to 3600");
  refuse("fov = 50\n[[tile]]\nfile = 'a.exr'\nyav = 3\n", "tiles.toml:4: unknown key `yav`; ");
  refuse("fov = 50\n[[tile]]\nfile = 'a.exr'\n[[tile]]\nfile = 'a.exr'\nyaw = 90\n",
         "a.exr: is not connected to ");
  writeImage(path("black.exr"), constantProbe({8, 8}, Rgb(0)));
  const std::string black = "[[tile]]\nfile = 'black.exr'\n", overlapping = "yaw = 20\n";
  constexpr const char* kBlack =
      "where they overlap, one or both are black; if all have the same exposure, give "
      "--same-exposure";
  refuse("fov = 50\n" + black + black + overlapping, kBlack);
  refuse("fov = 50\n[[tile]]\nfile = 'a.exr'\n" + black + overlapping, kBlack);
  refuse("fov = 50\n" + black + "[[tile]]\nfile = 'a.exr'\n" + overlapping, kBlack);
  expectError(
      {"probe", "stitch", list("fov = 50\n[[tile]]\nfile = 'a.exr'\n"), "-o", path("a.exr")},
      "a.exr");
  expectError(
      {"probe", "stitch", path("tiles.toml"), "-o", path("o.exr"), "--poses", path("p.toml")},
      "--poses: are those that --refine finds");
}

}  // namespace
}  // namespace chromeball::stitch_test
