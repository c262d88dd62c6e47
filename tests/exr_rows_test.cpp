// SPDX-License-Identifier: Apache-2.0
// OpenEXR files written and read by bands of rows are those written and read at once.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "base/error.h"
#include "image/io/exr_rows.h"
#include "image/io/write_image.h"
#include "run_command.h"

namespace chromeball::exr_rows_test {
namespace {

constexpr uint64_t kNoLimit = uint64_t(1) << 40;

Image pattern(int width, int height, int channels) {
  Image image(width, height, channels);
  for (size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = float((i * 7919) % 1021) / 8;
  return image;
}

Image rowsOf(const Image& image, int top, int count) {
  Image rows(image.width, count, image.channels);
  std::copy_n(image.at(0, top), rows.texels.size(), rows.texels.data());
  return rows;
}

ExrLayout layout(int width, int height, bool halves, bool separateRows) {
  return {.width = width,
          .height = height,
          .channels = {"R", "G", "B", "a.R", "a.G", "a.B"},
          .metadata = {{"name", std::string("rows")}},
          .halves = halves,
          .separateRows = separateRows};
}

TEST(ExrRows, BandsOfAnyHeightAreTheWhole) {
  const TemporaryFolder folder;
  const Image color = pattern(13, 37, 3), other = pattern(13, 37, 3);
  for (const bool halves : {false, true})
    for (const bool separateRows : {false, true})
      for (const int height : {1, 5, 16, 37}) {
        ExrRowsWriter writer(folder / "a.exr", layout(13, 37, halves, separateRows));
        for (int top = 0; top < 37; top += height) {
          const int count = std::min(height, 37 - top);
          const Image first = rowsOf(color, top, count), second = rowsOf(other, top, count);
          const Image* const images[] = {&first, &second};
          writer.write(images);
        }
        writer.commit();
        const ImageFile whole = readImageFile(folder / "a.exr");
        EXPECT_EQ(findColor(whole)->texels, color.texels);  // the pattern is exact in 16 bits
        EXPECT_EQ(findLayer(whole, "a")->texels, other.texels);
        ExrRowsReader reader(folder / "a.exr", kNoLimit);
        EXPECT_EQ(reader.channels(), whole.channels);
        EXPECT_EQ(std::get<std::string>(reader.contents().metadata.at("name")), "rows");
        for (int top = 0; top < 37; top += height) {
          const int count = std::min(height, 37 - top);
          ASSERT_EQ(reader.read(top, count).texels, rowsOf(whole.image, top, count).texels);
        }
        EXPECT_EQ(reader.read(20, 3).texels, rowsOf(whole.image, 20, 3).texels);  // back
      }
}

TEST(ExrRows, NothingRemainsWithoutCommit) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.exr") << "old";
  const Image rows = pattern(13, 10, 3);
  const Image* const images[] = {&rows, &rows};
  {
    ExrRowsWriter writer(folder / "a.exr", layout(13, 37, false, true));
    writer.write(images);
    EXPECT_EQ(folder.files().size(), 2u);
  }
  EXPECT_EQ(folder.files(), std::vector<std::string>{"a.exr"});
  EXPECT_EQ(fileContents(folder / "a.exr"), "old");
}

// Writes `file` with other numbers in its attribute dataWindow: the last column and row.
void writeWithSize(const std::string& path, std::string file, int32_t right, int32_t bottom) {
  const size_t box = file.find("dataWindow") + std::strlen("dataWindow") + 1 + 6 + 4;
  std::memcpy(file.data() + box + 8, &right, 4);
  std::memcpy(file.data() + box + 12, &bottom, 4);
  std::ofstream(path, std::ios::binary) << file;
}

TEST(ExrRows, RefusesDamagedFiles) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.exr";
  const Image rows = pattern(64, 64, 3);
  const Image* const images[] = {&rows, &rows};
  for (const bool separateRows : {false, true}) {
    ExrRowsWriter writer(path, layout(64, 64, false, separateRows));
    writer.write(images);
    writer.commit();
    const std::string good = fileContents(path);
    const auto refuses = [&](const std::string& reason) {
      try {
        ExrRowsReader reader(path, uint64_t(1) << 36);
        for (int top = 0; top < reader.height(); top += 16)
          reader.read(top, std::min(16, reader.height() - top));
        FAIL() << "read";
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
      }
    };
    for (const size_t length : {good.size() / 4, good.size() / 2, good.size() - 9}) {
      std::ofstream(path, std::ios::binary) << good.substr(0, length);
      refuses("a.exr: ");
    }
    writeWithSize(path, good, 1 << 30, 63);
    refuses("exceed the limit of 68719476736 numbers");
    writeWithSize(path, good, (1 << 17) - 1, (1 << 16) - 1);
    refuses("a.exr: ");  // 2^33 pixels with six channels; the file is too short
    writeWithSize(path, good, 63, (1 << 27) - 1);
    refuses("a.exr: ");
    writeWithSize(path, good, -5, 63);
    refuses("all must be positive");
  }
  std::ofstream(path) << "no picture";
  EXPECT_THROW(ExrRowsReader(path, kNoLimit), InputError);
}

}  // namespace
}  // namespace chromeball::exr_rows_test
