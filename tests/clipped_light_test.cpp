// SPDX-License-Identifier: Apache-2.0
// Light that photographs have lost: pixels marked in the layer `clipped`, and integers.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <fstream>

#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "run_command.h"

namespace chromeball::clipped_light_test {
namespace {

Image filled(int width, int height, int channels, float number) {
  Image image(width, height, channels);
  for (float& texel : image.texels) texel = number;
  return image;
}

class ClippedLight : public testing::Test {
 protected:
  // A grey picture whose pixels of x >= `from` are marked.
  std::string write(const std::string& name, int from, float grey = 0.5f) const {
    Image marks(64, 64, 1);
    for (int y = 0; y < 64; ++y)
      for (int x = from; x < 64; ++x) *marks.at(x, y) = 1;
    writeImage(folder_ / name,
               OutputImage{{{"", "RGB", filled(64, 64, 3, grey)}, {"clipped", "", marks}}});
    return folder_ / name;
  }

  const TemporaryFolder folder_;
  const std::string warning_ = "are brighter than what was measured (layer `clipped`)";
};

TEST_F(ClippedLight, IsNoMeasurementOfReflectivity) {
  const std::string half = write("half.exr", 32);
  const auto run = [&](const std::string& direct) {
    return runCommand(
        {"probe", "reflectivity", half, "--direct", direct, "--reflected", "2,2,8,8"});
  };
  EXPECT_EQ(run("20,20,8,8").status, 0);
  const CommandResult clipped = run("40,20,8,8");
  EXPECT_EQ(clipped.status, 2);
  EXPECT_NE(clipped.error.find("is saturated"), std::string::npos) << clipped.error;
}

TEST_F(ClippedLight, IsNoMeasurementOfAFlatField) {
  std::vector<std::string> command{"image", "flat-field", "-o", folder_ / "flat.exr"};
  for (int i = 0; i < 6; ++i) {
    command.push_back(write(fmt::format("{}.exr", i), 40));
    command.insert(command.end(), {"--at", fmt::format("{},32", 60 - 10 * i)});
  }
  const CommandResult result = runCommand(command);
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.error.find("the source at 60.0,32.0 is saturated"), std::string::npos)
      << result.error;
}

TEST_F(ClippedLight, IsNamedWhereExposuresAreCompared) {
  const std::string marked = write("a.exr", 32), unmarked = write("b.exr", 64);
  const auto said = [&](const std::string& file) {
    std::ofstream(folder_ / "t.toml") << fmt::format(
        "fov = 100\n[[tile]]\nfile = '{}'\nyaw = 0\n[[tile]]\nfile = 'b.exr'\nyaw = 60\n", file);
    return runCommand(
               {"probe", "stitch", folder_ / "t.toml", "-o", folder_ / "o.exr", "--size", "32x16"})
               .error +
           runCommand({"probe", "assemble", folder_ / file, "--from", "fisheye", "--circle",
                       "32,32,31", "-o", folder_ / "p.exr", "--size", "32x16"})
               .error;
  };
  const std::string ofMarked = said("a.exr");
  EXPECT_NE(ofMarked.find("50% of its pixels " + warning_), ofMarked.rfind(warning_)) << ofMarked;
  EXPECT_EQ(said("b.exr").find(warning_), std::string::npos);
}

TEST_F(ClippedLight, OfIntegersIsNamed) {
  writeImage(folder_ / "w.png", filled(8, 8, 3, 1));
  std::ofstream(folder_ / "t.toml") << "fov = 100\n[[tile]]\nfile = 'w.png'\nyaw = 0\n";
  std::ofstream(folder_ / "d.csv") << "w.png,0,1,0\n";
  writeImage(folder_ / "sky.exr", filled(8, 4, 3, 1));
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"probe", "stitch", folder_ / "t.toml", "-o", folder_ / "o.exr", "--size", "32x16"},
           {"relight", "--images", folder_ / ".", "--directions", folder_ / "d.csv", "--probe",
            folder_ / "sky.exr", "-o", folder_ / "r.exr"}}) {
    const CommandResult result = runCommand(command);
    EXPECT_EQ(result.status, 0) << result.error;
    EXPECT_NE(result.error.find("w.png: has integer texels: decoded from sRGB"), std::string::npos)
        << result.error;
  }
}

// What reads a file says how: not by its name.
TEST_F(ClippedLight, DecodingIsThatOfTheContents) {
  writeImage(folder_ / "p.exr", filled(16, 16, 3, 0.5f));
  std::filesystem::rename(folder_ / "p.exr", folder_ / "linear.png");
  writeImage(folder_ / "q.png", filled(16, 16, 3, 0.5f));
  std::filesystem::rename(folder_ / "q.png", folder_ / "encoded.exr");
  const auto said = [&](const std::string& file) {
    return runCommand({"probe", "reflectivity", folder_ / file, "--direct", "1,1,4,4",
                       "--reflected", "9,9,4,4"})
        .error;
  };
  EXPECT_EQ(said("linear.png").find("decoded from sRGB"), std::string::npos);
  EXPECT_NE(said("encoded.exr").find("decoded from sRGB"), std::string::npos);
}

TEST_F(ClippedLight, AlphaIsKeptByADivision) {
  Image coloured = filled(4, 4, 4, 0.5f);
  writeImage(folder_ / "a.exr",
             OutputImage{{{"", "RGBA", coloured}, {"albedo", "RGB", filled(4, 4, 3, 1)}}});
  writeImage(folder_ / "b.exr", filled(4, 4, 3, 0.5f));
  const CommandResult result = runCommand(
      {"image", "divide", folder_ / "a.exr", folder_ / "b.exr", "-o", folder_ / "c.exr"});
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_NE(result.error.find("without the layers albedo"), std::string::npos) << result.error;
  const auto quotient = findColorAndAlpha(readImageFile(folder_ / "c.exr"));
  ASSERT_TRUE(quotient && quotient->channels == 4);
  EXPECT_EQ(quotient->rgb(1, 1), Rgb(1));
  EXPECT_EQ(quotient->at(1, 1)[3], 0.5f);
}

// An attribute that the program writes too, but of another type.
TEST_F(ClippedLight, TheDateOfAnotherFileIsNotKept) {
  writeImage(folder_ / "a.exr",
             OutputImage{{{"", "RGB", filled(4, 4, 3, 0.5f)}}, {{"capDatX", 3.0f}}});
  std::string bytes = fileContents(folder_ / "a.exr");
  bytes.replace(bytes.find("capDate"), 7, "capDatY");
  bytes.replace(bytes.find("capDatX"), 7, "capDate");
  std::ofstream(folder_ / "b.exr", std::ios::binary) << bytes;
  const CommandResult result =
      runCommand({"image", "develop", folder_ / "b.exr", folder_ / "c.exr"});
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_EQ(readImage(folder_ / "c.exr").rgb(1, 1), Rgb(0.5f));
}

}  // namespace
}  // namespace chromeball::clipped_light_test
