// SPDX-License-Identifier: Apache-2.0
// How photographs were taken, by their EXIF blocks.
#include "image/io/exif.h"

#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "base/error.h"
#include "exif_block.h"
#include "image/io/write_image.h"
#include "run_command.h"
#include "shared_data.h"

namespace chromeball::exif_test {
namespace {

std::string seed(const std::string& name) {
  return fileContents(std::string(kSourceDir) + "/tests/fuzz/seeds/image/" + name);
}

Exif exifOf(const std::string& contents, const TemporaryFolder& folder) {
  const std::string path = folder / "photograph";
  std::ofstream(path, std::ios::binary) << contents;
  return readExif(path);
}

void expectSettings(const Exif& exif) {
  EXPECT_DOUBLE_EQ(exif.exposureTime.value_or(0), 1. / 40);
  EXPECT_DOUBLE_EQ(exif.aperture.value_or(0), 1.8);
  EXPECT_DOUBLE_EQ(exif.iso.value_or(0), 100);
}

const std::vector<ExifEntry> kSettings = {exposureTime(1, 40), fNumber(18, 10), isoSpeed(100)};

// The largest number of 16 bits stands for a larger one in another entry.
TEST(Exif, SensitivitiesAbove65535) {
  const TemporaryFolder folder;
  for (const uint16_t tag : {0x8831, 0x8832, 0x8833}) {
    const std::vector<ExifEntry> high = {isoSpeed(65535), {tag, 409600, 1}};
    EXPECT_EQ(exifOf(exifBlock(high), folder).iso, 409600) << tag;
    const std::vector<ExifEntry> low = {isoSpeed(100), {tag, 409600, 1}};
    EXPECT_EQ(exifOf(exifBlock(low), folder).iso, 100) << tag;
  }
}

TEST(Exif, OfEachFormatAndByteOrder) {
  const TemporaryFolder folder;
  for (const bool isBig : {false, true}) {
    const std::string block = exifBlock(kSettings, isBig);
    expectSettings(exifOf(withExif(seed("a.jpg"), block), folder));
    expectSettings(exifOf(withExif(seed("a.png"), block), folder));
    expectSettings(exifOf(block, folder));  // a TIFF without an image
  }
  Image image(2, 2, 3);
  writeImage(folder / "a.exr",
             OutputImage{{{"", "RGB", image}},
                         {{"expTime", 0.025f}, {"aperture", 1.8f}, {"isoSpeed", 100.f}},
                         {},
                         {}});
  const Exif exif = readExif(folder / "a.exr");
  EXPECT_FLOAT_EQ(float(exif.exposureTime.value_or(0)), 0.025f);
  EXPECT_FLOAT_EQ(float(exif.aperture.value_or(0)), 1.8f);
  EXPECT_FLOAT_EQ(float(exif.iso.value_or(0)), 100);
}

TEST(Exif, WhatIsMissingOrMeaninglessIsEmpty) {
  const TemporaryFolder folder;
  for (const char* name : {"a.jpg", "a.png", "a.tif", "a.pfm", "flat.hdr", "small.exr"}) {
    const Exif exif = exifOf(seed(name), folder);
    EXPECT_FALSE(exif.exposureTime || exif.aperture || exif.iso) << name;
  }
  const Exif zero = exifOf(
      withExif(seed("a.jpg"), exifBlock({exposureTime(0, 40), isoSpeed(0), fNumber(18, 10)})),
      folder);
  EXPECT_FALSE(zero.exposureTime || zero.iso);
  EXPECT_TRUE(zero.aperture);
  EXPECT_THROW(readExif(folder / "none.jpg"), InputError);
}

// The block is the end of the file, so that reading beyond it would be seen by a sanitizer.
TEST(Exif, DamagedBlocksAreHarmless) {
  const TemporaryFolder folder;
  const std::string block = exifBlock(kSettings);
  for (size_t length = 0; length < block.size(); ++length)
    exifOf(withExif(seed("a.png"), block.substr(0, length)), folder);
  std::mt19937 random(1);
  for (int i = 0; i < 500; ++i) {
    std::string damaged = block;
    for (int j = 0; j < 4; ++j) damaged[random() % damaged.size()] = char(random());
    const Exif exif = exifOf(damaged, folder);
    for (const auto& number : {exif.exposureTime, exif.aperture, exif.iso})
      EXPECT_GT(number.value_or(1), 0);
  }
}

// A BigTIFF whose pointer to the directory of EXIF, of 64 bits, has no integer that equals it as a
// double. A sanitizer sees the conversion.
TEST(Exif, AnEndlessPointerIsHarmless) {
  const TemporaryFolder folder;
  const auto word = [](uint64_t value) {
    std::string reversed = bigEndian(value, 8);
    return std::string(reversed.rbegin(), reversed.rend());
  };
  const std::string entry("\x69\x87\x10\0", 4);  // the tag; LONG8
  const std::string file = std::string("II\x2b\0\x8\0\0\0", 8) + word(16) + word(1) + entry +
                           word(1) + word(~uint64_t(0)) + word(0);
  EXPECT_FALSE(exifOf(file, folder).iso);
}

TEST(Exif, RealPhotographs) {
  const auto folder = sharedData("reference/differential_rendering/kartikagrawal27/Materials");
  if (!folder) GTEST_SKIP() << "no real photographs";
  for (const auto& [name, inverse] : {std::pair{"10.JPG", 10}, {"40.JPG", 40}, {"160.JPG", 160}}) {
    const Exif exif = readExif(*folder / name);
    EXPECT_NEAR(exif.exposureTime.value_or(0) * inverse, 1, 1e-3) << name;
    EXPECT_NEAR(exif.aperture.value_or(0), 1.8, 1e-9) << name;
    EXPECT_EQ(exif.iso, 100) << name;
    EXPECT_EQ(exif.focalLength35, 28) << name;
  }
}

}  // namespace
}  // namespace chromeball::exif_test
