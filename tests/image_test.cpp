// SPDX-License-Identifier: Apache-2.0
// Reading and writing images, and tone mapping.
#include "image/image.h"

#include <gtest/gtest.h>

#include <bit>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "image/io/pfm.h"
#include "image/io/radiance_hdr.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "image/tonemap.h"
#include "run_command.h"
#include "shared_data.h"

namespace chromeball::image_test {
namespace {

// Values over the whole range of float, with full mantissas.
Image fullRangeImage(int width, int height, int channels) {
  Image image(width, height, channels);
  for (size_t i = 0; i < image.texels.size(); ++i)
    image.texels[i] = std::ldexp(1 + float(i % 97) / 97, int(i * 7 % 120) - 60);
  return image;
}

void write(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

void expectInputError(const std::string& path, const std::string& reason) {
  try {
    readImage(path);
    ADD_FAILURE() << path << " was read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    EXPECT_TRUE(std::string(error.what()).starts_with(path)) << error.what();
  }
}

TEST(Image, ExrAndPfmAreLossless) {
  const TemporaryFolder folder;
  Image image = fullRangeImage(17, 9, 3);
  image.at(0, 0)[0] = std::numeric_limits<float>::infinity();
  image.at(1, 0)[0] = -1e6f;
  image.at(2, 0)[0] = 1e-40f;
  for (const char* name : {"a.exr", "a.pfm"}) {
    writeImage(folder / name, image);
    EXPECT_EQ(readImage(folder / name).texels, image.texels) << name;
  }
}

TEST(Image, ExrExceedsTheRangeOfHalf) {
  const TemporaryFolder folder;
  Image image(1, 1, 3);
  image.setRgb(0, 0, Rgb(1e7f, 3e38f, 1e-30f));
  writeImage(folder / "a.exr", image);
  EXPECT_EQ(readImage(folder / "a.exr").texels, image.texels);
}

TEST(Image, HdrRoundsToTheNearestMantissa) {
  const TemporaryFolder folder;
  for (const int width : {3, 8, 200, 300}) {
    const Image image = fullRangeImage(width, 5, 3);
    writeImage(folder / "a.hdr", image);
    const Image back = readImage(folder / "a.hdr");
    ASSERT_EQ(back.width, width);
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < width; ++x) {
        const Rgb a = image.rgb(x, y), b = back.rgb(x, y);
        // Half a unit of a mantissa of at least 128.
        for (int c = 0; c < 3; ++c) EXPECT_LE(std::fabs(a[c] - b[c]), maxComponent(a) / 255);
      }
  }
}

TEST(Image, HdrIsNotBiased) {
  const TemporaryFolder folder;
  Image image(256, 64, 3);
  double sum = 0, sumBack = 0;
  for (size_t i = 0; i < image.texels.size(); ++i)
    sum += image.texels[i] = 1 + float(i * 2654435761u % 100003) / 100003;
  writeImage(folder / "a.hdr", image);
  for (const float f : readImage(folder / "a.hdr").texels) sumBack += f;
  EXPECT_NEAR(sumBack / sum, 1, 1e-4);
}

TEST(Image, HdrLongRunsRoundTrip) {
  const TemporaryFolder folder;
  Image image(1000, 3, 3);
  for (int x = 0; x < 1000; ++x)
    for (int y = 0; y < 3; ++y) image.setRgb(x, y, Rgb(x / 300 == 1 ? 0.5f : 0.0f, 1, 2));
  image.setRgb(999, 2, Rgb(1, 1, 1));
  writeImage(folder / "a.hdr", image);
  EXPECT_EQ(readImage(folder / "a.hdr").texels, image.texels);
}

TEST(Image, HdrExposureAndOrientationAreApplied) {
  const TemporaryFolder folder;
  const std::string texels{"\x80\x40\x20\x81\x10\x80\x10\x81", 8};  // (1, .5, .25), (.125, 1, .125)
  write(folder / "a.hdr",
        "#?RGBE\nEXPOSURE=4\nEXPOSURE= 0.5\nFORMAT=32-bit_rle_rgbe\n\n+Y 2 -X 1\n" + texels);
  const Image image = readImage(folder / "a.hdr");
  EXPECT_EQ(image.rgb(0, 1), Rgb(0.5f, 0.25f, 0.125f));  // +Y: the first row is the lowest
  EXPECT_EQ(image.rgb(0, 0), Rgb(0.0625f, 0.5f, 0.0625f));
}

// "Radiance File Formats", picture files: the first axis gives the order of the rows.
TEST(Image, HdrRowsInEachOrder) {
  const TemporaryFolder folder;
  std::string texels;
  for (int i = 0; i < 6; ++i) texels += {char(0x80 + i), 0, 0, char(0x81)};
  for (const char first : {'-', '+'})
    for (const char second : {'-', '+'})
      for (const bool areColumns : {false, true}) {
        const std::string order = fmt::format("{}{} 2 {}{} 3", first, areColumns ? 'X' : 'Y',
                                              second, areColumns ? 'Y' : 'X');
        write(folder / "a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + order + "\n" + texels);
        const Image image = readImage(folder / "a.hdr");
        ASSERT_EQ(image.width, areColumns ? 2 : 3) << order;
        ASSERT_EQ(image.height, areColumns ? 3 : 2);
        for (int i = 0; i < 6; ++i) {
          const int row = i / 3, texel = i % 3;
          const int x = areColumns ? (first == '+' ? row : 1 - row)
                                   : (second == '+' ? texel : 2 - texel),
                    y = areColumns ? (second == '-' ? texel : 2 - texel)
                                   : (first == '-' ? row : 1 - row);
          EXPECT_EQ(image.rgb(x, y).x, float(0x80 + i) / 0x80) << order << " texel " << i;
        }
      }
}

TEST(Image, HdrMatchesReferenceDecoder) {
  for (const char* name : {"image1", "old-rle", "rgbr4x4", "scale"}) {
    const auto hdr = sharedData(std::string("reference/hdr_decode/") + name + ".hdr");
    const auto tiff = sharedData(std::string("reference/hdr_decode/") + name + ".reference.tiff");
    if (!hdr || !tiff) GTEST_SKIP() << "no reference/hdr_decode";
    EXPECT_EQ(readImage(*hdr).texels, readImage(*tiff).texels) << name;
  }
}

// Radiance's programs note their command lines.
TEST(Image, HdrHeadersMayHaveLongLines) {
  const TemporaryFolder folder;
  const auto withLine = [&](size_t length) {
    return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\npcomb " + std::string(length, 'x') +
           "\n\n-Y 1 +X 1\n" + std::string("\x80\x80\x80\x81", 4);
  };
  write(folder / "a.hdr", withLine(100'000));
  EXPECT_EQ(readImage(folder / "a.hdr").width, 1);
  write(folder / "a.hdr", withLine(2 << 20));
  expectInputError(folder / "a.hdr", "a line of the Radiance header has more than");
}

TEST(Image, DamagedHdrIsRejected) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.hdr", head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
  const auto expectError = [&](const std::string& bytes, const std::string& reason) {
    write(path, bytes);
    expectInputError(path, reason);
  };
  expectError(head + "-Y 100000 +X 100000\n", "exceed the limit");
  expectError(head + "-Y 0 +X 5\n", "0");
  expectError(head + "-Y -5 +X 5\n", "-5");
  for (const char* order : {"+X 5 -X 5", "-Y 5 +Y 5", "Y 5 X 5", "-Y 5", "-Z 5 +X 5"})
    expectError(head + order + "\n", "resolution");
  expectError(head + "-Y 8000 +X 8000\n" + std::string("\2\2\x1f\x40", 4), "too short");
  expectError(head + "-Y 1 +X 8\n" + std::string("\2\2\0\x8\xff\1------", 12), "a run exceeds");
  expectError(head + "-Y 1 +X 4\n" + std::string("\1\1\1\4", 4), "a run exceeds");
  expectError(head + "-Y 1 +X 4\n" + std::string("\1\1\2\4", 4), "ends");
  for (const char* exposure : {"0", "1,5", "1/2", "2x", "2 3", "abc"})
    expectError(std::string("#?RADIANCE\nEXPOSURE=") + exposure + "\n\n-Y 1 +X 1\n1234",
                "EXPOSURE");
  expectError("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n1234", "rgbe");
  expectError("#?RADIANCE", "end");
}

TEST(Image, PfmBigEndianAndGrey) {
  const TemporaryFolder folder;
  write(folder / "big.pfm", "Pf\n1 2\n1.0\n" + std::string("\x3f\x80\0\0\x40\0\0\0", 8));
  const Image image = readImage(folder / "big.pfm");  // big-endian, grey, bottom row first
  EXPECT_EQ(image.rgb(0, 0), Rgb(2));
  EXPECT_EQ(image.rgb(0, 1), Rgb(1));
  write(folder / "dos.pfm", "Pf\r\n1 2\r\n1.0\r\n" + std::string("\x3f\x80\0\0\x40\0\0\0", 8));
  EXPECT_EQ(readImage(folder / "dos.pfm").texels, image.texels);
  for (const char* scale : {"1.0 \n", "1.0 \t\r\n", "+1.0\n", "1 "}) {
    write(folder / "a.pfm",
          std::string("Pf\n1 2\n") + scale + std::string("\x3f\x80\0\0\x40\0\0\0", 8));
    EXPECT_EQ(readImage(folder / "a.pfm").texels, image.texels) << scale;
  }
  // A texel may begin with a byte that ends a line.
  write(folder / "a.pfm", "Pf\n1 1\n1.0\n" + std::string("\n\n\0\0", 4));
  EXPECT_EQ(readImage(folder / "a.pfm").rgb(0, 0), Rgb(std::bit_cast<float>(0x0a0a0000)));
  // The magnitude of the scale is a factor, which is reported.
  for (const char* scale : {"2.0", "0.25", "1e10"}) {
    write(folder / "scaled.pfm",
          std::string("Pf\n1 2\n") + scale + "\n" + std::string("\x3f\x80\0\0\x40\0\0\0", 8));
    const ImageFile scaled = readImageFile(folder / "scaled.pfm");
    EXPECT_EQ(scaled.image.texels[1], std::stof(scale));
    ASSERT_EQ(scaled.messages.size(), 1u);
    EXPECT_NE(scaled.messages[0].text.find("multiplied by the scale"), std::string::npos);
  }
  EXPECT_TRUE(readImageFile(folder / "big.pfm").messages.empty());
  write(folder / "scale.pfm", "Pf\n1 1\n-1e30\n1234");
  expectInputError(folder / "scale.pfm", "the scale of a PFM");
  write(folder / "short.pfm", "PF\n2 2\n-1\n1234");
  expectInputError(folder / "short.pfm", "need");
  write(folder / "huge.pfm", "PF\n2000000000 2000000000\n-1\n1234");
  expectInputError(folder / "huge.pfm", "exceed the limit");
  write(folder / "word.pfm", "PF\ntwo 2\n-1\n1234");
  expectInputError(folder / "word.pfm", "header");
}

TEST(Image, PngIsSrgbBothWays) {
  const TemporaryFolder folder;
  Image image(256, 1, 3);
  for (int x = 0; x < 256; ++x) image.setRgb(x, 0, Rgb(srgbToLinear(float(x) / 255)));
  writeImage(folder / "a.png", image);
  const Image linear = readImage(folder / "a.png");
  const Image encoded = readImage(folder / "a.png", IntegerTexels::Linear);
  for (int x = 0; x < 256; ++x) {
    EXPECT_NEAR(linear.rgb(x, 0).x, image.rgb(x, 0).x, 1e-6f);
    EXPECT_NEAR(encoded.rgb(x, 0).y, float(x) / 255, 1e-6f);
  }
}

TEST(Image, LayersAndMetadata) {
  const TemporaryFolder folder;
  const std::string path = folder / "layers.exr";
  const Image color = fullRangeImage(4, 3, 4), albedo = fullRangeImage(4, 3, 3);
  const Image depth = fullRangeImage(4, 3, 1), samples = fullRangeImage(4, 3, 1);
  writeImage(path,
             OutputImage{{{"", "RGBA", color},
                          {"normal", "XYZ", albedo},
                          {"variance", "RGB", albedo},
                          {"depth", "Z", depth},
                          {"samples", "", samples}},
                         {{"strategy", "bsdf"}, {"seed", 7}, {"seconds", 1.5f}, {"shutter", 0.7}}});
  const ImageFile file = readImageFile(path);
  EXPECT_EQ(findLayer(file, "normal")->texels, albedo.texels);
  EXPECT_EQ(findLayer(file, "variance")->texels, albedo.texels);
  EXPECT_EQ(findLayer(file, "depth")->texels, depth.texels);
  EXPECT_EQ(findLayer(file, "samples")->texels, samples.texels);
  EXPECT_FALSE(findLayer(file, "albedo"));
  EXPECT_EQ(readImage(path).rgb(3, 2), color.rgb(3, 2));
  EXPECT_EQ(std::get<std::string>(file.metadata.at("strategy")), "bsdf");
  EXPECT_EQ(std::get<int>(file.metadata.at("seed")), 7);
  EXPECT_EQ(std::get<float>(file.metadata.at("seconds")), 1.5f);
  EXPECT_EQ(std::get<double>(file.metadata.at("shutter")), 0.7);
  for (const auto& [name, number] :
       {std::pair("seed", 7.0), std::pair("seconds", 1.5), std::pair("shutter", 0.7)})
    EXPECT_EQ(metadataNumber(file.metadata, name), number);
  EXPECT_EQ(metadataNumber(file.metadata, "strategy"), std::nullopt);
  EXPECT_EQ(metadataNumber(file.metadata, "none"), std::nullopt);
  std::vector<std::string> names = layerNames(file);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"depth", "normal", "samples", "variance"}));
}

TEST(Image, ColourOfLayersAndGrey) {
  const TemporaryFolder folder;
  const Image color = fullRangeImage(4, 3, 3), grey = fullRangeImage(4, 3, 1);
  writeImage(folder / "a.exr", OutputImage{{{"beauty", "RGB", color}}, {}});
  EXPECT_EQ(readImage(folder / "a.exr").texels, color.texels);
  for (const char* name : {"g.exr", "g.pfm"}) {
    writeImage(folder / name, grey);
    EXPECT_EQ(readImage(folder / name).rgb(2, 1), Rgb(*grey.at(2, 1))) << name;
  }
  writeImage(folder / "x.exr", OutputImage{{{"", "UVW", color}}, {}});
  expectInputError(folder / "x.exr", "has no colour");
}

TEST(Image, WritesAllOrNothing) {
  const TemporaryFolder folder;
  const Image image = fullRangeImage(4, 4, 3);
  for (const char* name : {"a.exr", "a.hdr", "a.pfm", "a.png"}) {
    writeImage(folder / name, image);
    writeImage(folder / name, image);  // replaces
  }
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.exr", "a.hdr", "a.pfm", "a.png"}));

  std::filesystem::create_directory(folder / "d.exr");
  EXPECT_THROW(writeImage(folder / "d.exr", image), InputError);
  EXPECT_THROW(writeImage(folder / "a.jpg", image), InputError);
  EXPECT_THROW(writeImage(folder / "a", image), InputError);
  EXPECT_THROW(writeImage(folder / "none/a.exr", image), InputError);
  EXPECT_EQ(folder.files().size(), 5u);
}

TEST(Image, FailedWriteIsARunError) {
  // A folder that exists but into which no file can be written.
  if (!std::filesystem::exists("/proc/self")) GTEST_SKIP() << "no /proc";
  EXPECT_THROW(writePfm("/proc/chromeball.pfm", Image(1, 1, 3)), RunError);
  EXPECT_THROW(writeRadianceHdr("/proc/chromeball.hdr", Image(1, 1, 3)), RunError);
}

TEST(Image, MissingAndUnreadableFilesAreRejected) {
  const TemporaryFolder folder;
  expectInputError(folder / "none.exr", "no such file");
  expectInputError(std::filesystem::temp_directory_path().string(), "not a regular file");
  write(folder / "empty.exr", "");
  expectInputError(folder / "empty.exr", "cannot be read");
  write(folder / "text.png", "not an image at all");
  expectInputError(folder / "text.png", "cannot be read");
}

TEST(ToneMap, SrgbIsItsOwnInverse) {
  for (int i = -100; i <= 200; ++i)
    EXPECT_NEAR(srgbToLinear(linearToSrgb(float(i) / 100)), float(i) / 100, 1e-6f);
  EXPECT_NEAR(linearToSrgb(0.18f), 0.46135f, 1e-4f);
}

TEST(ToneMap, OperatorsAreMonotonicInTheDisplayRange) {
  for (const std::string_view name : toneOperatorNames()) {
    const ToneOperator tone = parseToneOperator(name);
    float last = -1;
    for (int stop = -80; stop <= 80; ++stop) {
      const Rgb shown = display({tone}, Rgb(std::exp2(float(stop) / 8)));
      EXPECT_GE(shown.x, last - 1e-6f) << name << " at " << stop;
      EXPECT_LE(shown.x, 1) << name;
      last = shown.x;
    }
    EXPECT_GT(last, 0.95f) << name;
    EXPECT_LT(maxComponent(display({tone}, Rgb(0))), 0.001f) << name;
  }
  EXPECT_THROW(parseToneOperator("acess"), InputError);
}

TEST(ToneMap, KnownPoints) {
  // Exposure is in stops; Reinhard's white becomes 1; neutral subtracts its 4% from a mid grey.
  EXPECT_FLOAT_EQ(display({ToneOperator::None, 2}, Rgb(0.125f)).x, 0.5f);
  EXPECT_NEAR(display({ToneOperator::Reinhard}, Rgb(4)).x, 1, 1e-6f);
  EXPECT_NEAR(display({ToneOperator::PbrNeutral}, Rgb(0.5f)).x, 0.46f, 1e-6f);
  EXPECT_NEAR(display({ToneOperator::Filmic}, Rgb(11.2f)).x, 1, 1e-5f);
  const float infinity = std::numeric_limits<float>::infinity();
  const Rgb invalid(infinity, -1, std::numeric_limits<float>::quiet_NaN());
  for (const std::string_view name : toneOperatorNames())
    EXPECT_TRUE(isFinite(display({parseToneOperator(name)}, invalid))) << name;
}

}  // namespace
}  // namespace chromeball::image_test
