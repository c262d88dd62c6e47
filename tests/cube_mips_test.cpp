// SPDX-License-Identifier: Apache-2.0
// Chains of prefiltered cube maps, and chromeball probe convolve.
#include "base/json.h"
#include "json_file.h"
#include "probe/prefiltered_probe.h"

#include <Imath/half.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "base/error.h"
#include "image/io/write_image.h"
#include "npm_packages.h"
#include "probe/convolve.h"
#include "probe/irradiance.h"
#include "probe/synth.h"
#include "run_command.h"

namespace chromeball::cube_mips_test {
namespace {

// The direction of OpenGL 4.6, section 8.13: from face and texture coordinates in [-1, 1].
dvec3 openGlDirection(int face, double s, double t) {
  switch (face) {
    case 0:
      return {1, -t, -s};
    case 1:
      return {-1, -t, s};
    case 2:
      return {s, 1, t};
    case 3:
      return {s, -1, -t};
    case 4:
      return {s, -t, 1};
    default:
      return {-s, -t, -1};
  }
}

// Each level of a gradient has its closed form, where OpenGL looks it up; to a tenth of its change
// over a texel of the map.
TEST(SlowCubeMips, LevelsOfAGradient) {
  const dvec3 slope(0.5, -0.3, 0.2);
  const std::vector<CubeLevel> levels =
      cubeMips(gradientProbe({256, 128}, Rgb(1), slope), 64, MipRoughness::Khronos);
  ASSERT_EQ(levels.size(), 3u);
  for (size_t k = 0; k < levels.size(); ++k) {
    const auto& [roughness, faces] = levels[k];
    EXPECT_EQ(roughness, double(k) / 2);
    const int size = faces.width;
    EXPECT_EQ(size, 64 >> k);
    double factor = 1;
    if (k > 0) {
      const auto moments = ZonalKernel::ggx(roughness).legendreMoments();
      factor = moments[1] / moments[0];
    }
    for (int face = 0; face < 6; ++face)
      for (int y = 0; y < size; y += 3)
        for (int x = 0; x < size; x += 3) {
          const dvec3 d = glm::normalize(
              openGlDirection(face, (2 * x + 1.0) / size - 1, (2 * y + 1.0) / size - 1));
          EXPECT_NEAR(faces.rgb(x, face * size + y).x, 1 + factor * glm::dot(slope, d), 2e-3)
              << k << ' ' << face;
        }
  }
}

TEST(SlowCubeMips, RoughnessOfTheLevels) {
  const Image map = constantProbe({4, 2}, Rgb(1));
  const std::vector<CubeLevel> levels = cubeMips(map, 64, MipRoughness::Filament);
  ASSERT_EQ(levels.size(), 3u);
  for (size_t k = 0; k < levels.size(); ++k) {
    const double r = levels[k].roughness;
    EXPECT_NEAR(r * (2 - r), double(k) / 2, 1e-12);
  }
  EXPECT_EQ(cubeMips(map, 8, MipRoughness::Khronos).size(), 1u);
  for (const int size : {0, -4, 3, 100, 8192})
    EXPECT_THROW(cubeMips(map, size, MipRoughness::Khronos), InputError) << size;
}

template <class Integer>
Integer at(const std::string& bytes, size_t offset) {
  Integer value;
  std::memcpy(&value, bytes.substr(offset, sizeof value).data(), sizeof value);
  return value;
}

class SlowCommandConvolve : public testing::Test {
 protected:
  TemporaryFolder folder_;
  std::string in_ = folder_ / "in.exr";

  SlowCommandConvolve() { writeImage(in_, gradientProbe({64, 32}, Rgb(2, 1, 1e5f), {0, 0.5, 0})); }
  CommandResult run(const std::string& out, std::vector<std::string> more) {
    more.insert(more.begin(), {"probe", "convolve", in_, folder_ / out});
    return runCommand(more);
  }
};

TEST_F(SlowCommandConvolve, WritesKtx2) {
  const CommandResult result = run("o.ktx2", {"--size", "64x64"});
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_NE(result.error.find("exceed a half float"), std::string::npos);
  EXPECT_NE(result.out.find("16x16: roughness 1"), std::string::npos);
  const std::string file = fileContents(folder_ / "o.ktx2");
  EXPECT_EQ(file.substr(0, 12), "\xABKTX 20\xBB\r\n\x1A\n");
  const std::array<uint32_t, 9> header{97, 2, 64, 64, 0, 0, 6, 3, 0};
  for (size_t i = 0; i < header.size(); ++i) EXPECT_EQ(at<uint32_t>(file, 12 + 4 * i), header[i]);
  const auto descriptor = at<uint32_t>(file, 48), length = at<uint32_t>(file, 52);
  EXPECT_EQ(at<uint32_t>(file, descriptor), length);
  EXPECT_EQ(at<uint32_t>(file, 56), descriptor + length);
  const auto top = [&](size_t level) {  // the middle of +Y
    const uint64_t offset = at<uint64_t>(file, 80 + 24 * level),
                   bytes = at<uint64_t>(file, 88 + 24 * level), size = 64 >> level;
    EXPECT_EQ(bytes, 6 * size * size * 8);
    EXPECT_EQ(at<uint64_t>(file, 96 + 24 * level), bytes);
    EXPECT_EQ(offset % 8, 0u);
    EXPECT_LE(offset + bytes, file.size());
    half value;
    value.setBits(at<uint16_t>(file, offset + 8 * (size * size * 2 + size * size / 2 + size / 2)));
    return float(value);
  };
  EXPECT_NEAR(top(0), 3, 0.01);
  EXPECT_NEAR(top(2), 2 * (1 + 0.5 * 2 / 3), 0.01);
  EXPECT_EQ(at<uint64_t>(file, 80) + at<uint64_t>(file, 88), file.size());  // the largest is last
}

// Prints what ktx-parse finds in a file, as JSON; for each level, the texel right below the middle
// of each face.
constexpr const char* kParse = R"(
  import { readFileSync } from 'node:fs';
  import { read } from 'ktx-parse';
  const half = bits => {  // IEEE 754 binary16
    const exponent = bits >> 10 & 31, fraction = bits & 1023;
    const value = exponent ? 2 ** (exponent - 25) * (1024 + fraction) : 2 ** -24 * fraction;
    return bits >> 15 ? -value : value;
  };
  const ktx = read(readFileSync(process.argv[2]));
  ktx.levels = ktx.levels.map(({ levelData }, level) => {
    const size = ktx.pixelWidth >> level;
    const data = new DataView(levelData.buffer, levelData.byteOffset, levelData.byteLength);
    const texel = at => [0, 2, 4, 6].map(channel => half(data.getUint16(8 * at + channel, true)));
    return [0, 1, 2, 3, 4, 5].map(face => texel((face + 0.5) * size * size + size / 2));
  });
  console.log(JSON.stringify(ktx));
)";

// The parser is the one of three.js. The gradient differs in all six directions and three channels.
TEST_F(SlowCommandConvolve, KtxParseReadsTheKtx2) {
  if (!linkNpmPackages(folder_ / "")) GTEST_SKIP() << kNoNpmPackages;
  const dvec3 slope(0.5, -0.3, 0.2);
  const Rgb color(0.5f, 1, 2);
  writeImage(in_, gradientProbe({256, 128}, color, slope));
  ASSERT_EQ(run("o.ktx2", {"--size", "64x64"}).status, 0);
  std::ofstream(folder_ / "parse.mjs") << kParse;
  const std::string command = "node " + folder_ / "parse.mjs" + " " + folder_ / "o.ktx2" + " > " +
                              folder_ / "json" + " 2> " + folder_ / "log";
  ASSERT_EQ(std::system(command.c_str()), 0) << fileContents(folder_ / "log");
  const auto ktx = jsonOfFile(folder_ / "json");
  EXPECT_EQ(ktx["vkFormat"], 97);  // VK_FORMAT_R16G16B16A16_SFLOAT
  EXPECT_EQ(ktx["faceCount"], 6);
  EXPECT_EQ(ktx["keyValue"]["KTXorientation"], "rd");
  const auto& format = ktx["dataFormatDescriptor"][0];
  EXPECT_EQ(format["colorModel"], 1);        // RGBSDA
  EXPECT_EQ(format["colorPrimaries"], 1);    // of BT.709
  EXPECT_EQ(format["transferFunction"], 1);  // linear
  ASSERT_EQ(format["samples"].size(), 4u);
  ASSERT_EQ(ktx["levels"].size(), 3u);
  for (size_t level = 0; level < 3; ++level) {
    double factor = 1;
    if (level > 0) {
      const auto moments = ZonalKernel::ggx(double(level) / 2).legendreMoments();
      factor = moments[1] / moments[0];
    }
    const double middle = std::ldexp(1, int(level)) / 64;
    for (int face = 0; face < 6; ++face) {
      const dvec3 d = glm::normalize(openGlDirection(face, middle, middle));
      const auto& texel = ktx["levels"][level][size_t(face)];
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(double(texel[size_t(c)]) / color[c], 1 + factor * glm::dot(slope, d), 3e-3)
            << level << ' ' << face << ' ' << c;
      EXPECT_EQ(texel[3], 1);
    }
  }
}

// All three are exact for a gradient, up to its texels: 5.6 degrees, 11 in the reduced map.
TEST_F(SlowCommandConvolve, WritesMaps) {
  ASSERT_EQ(run("d.pfm", {"--kernel", "diffuse", "--size", "16x8"}).status, 0);
  ASSERT_EQ(run("s.pfm", {"--kernel", "diffuse", "--size", "16x8", "--method", "sh"}).status, 0);
  ASSERT_EQ(run("p.pfm", {"--kernel", "phong:1", "--size", "16x8", "--from-size", "32x16"}).status,
            0);
  const Image exact = irradianceMap(readImage(in_), {16, 8});
  for (const char* name : {"d.pfm", "s.pfm", "p.pfm"}) {
    const Image map = readImage(folder_ / name);
    ASSERT_EQ(map.width, 16);
    for (int i = 0; i < 16; i += 5)
      EXPECT_NEAR(map.rgb(i, 3).x, exact.rgb(i, 3).x * kInvPi, 5e-3) << name;
  }
  ASSERT_EQ(run("r.pfm", {"--kernel", "ggx:0.3", "--rotation", "0,90,0"}).status, 0);
  const Image turned = readImage(folder_ / "r.pfm");
  EXPECT_EQ(turned.width, 64);  // as the probe; the bright top is on +Z now
  EXPECT_GT(turned.rgb(0, 16).x, 2.5f);
}

TEST_F(SlowCommandConvolve, Errors) {
  const auto fails = [&](const std::string& out, const std::vector<std::string>& more,
                         const std::string& reason) {
    std::vector<std::string> all{"probe", "convolve", in_, folder_ / out};
    all.insert(all.end(), more.begin(), more.end());
    expectError(all, reason);
    EXPECT_FALSE(std::filesystem::exists(folder_ / out));
  };
  fails("o.exr", {}, "--kernel: give diffuse");
  fails("o.exr", {"--kernel", "blinn"}, "unknown kernel `blinn`");
  fails("o.exr", {"--kernel", "diffuse:2"}, "unknown kernel `diffuse`");
  fails("o.exr", {"--kernel", "ggx"}, "ggx needs a roughness");
  fails("o.exr", {"--kernel", "phong:"}, "--kernel");
  fails("o.exr", {"--kernel", "phong:0.5"}, "from 1 to 1e8");
  fails("o.exr", {"--kernel", "ggx:0"}, "from 0.01 to 1");
  fails("o.exr", {"--kernel", "ggx:nan"}, "is not a number");
  fails("o.exr", {"--kernel", "diffuse", "--mips", "khronos"}, "only a .ktx2 has levels");
  fails("o.exr", {"--kernel", "diffuse", "--method", "fast"}, "unknown method");
  fails("o.exr", {"--kernel", "diffuse", "--from-size", "128x64"}, "larger than the map");
  fails("o.ktx2", {"--kernel", "diffuse"}, "a .ktx2 has a level for each");
  fails("o.ktx2", {"--mips", "unity"}, "unknown roughness of levels `unity`");
  fails("o.ktx2", {"--size", "64x32"}, "a face of a cube is square");
  fails("o.ktx2", {"--size", "48x48"}, "a power of two");
  fails("none/o.ktx2", {}, "none");
}

}  // namespace
}  // namespace chromeball::cube_mips_test
