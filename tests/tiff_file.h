// SPDX-License-Identifier: Apache-2.0
// TIFF files of several images (TIFF 6.0, little-endian).
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace chromeball {

// Type 3: numbers of 16 bits; 4: of 32; 5: pairs of 32, numerator and denominator; 7: bytes.
struct TiffEntry {
  uint16_t tag, type;
  std::vector<uint32_t> values;
};

struct TiffImage {
  int width, height;
  std::string texels;                                                            // one strip
  uint16_t photometric = 2, samples = 3, bits = 8, compression = 1, format = 1;  // 0 bits: unstated
  std::vector<TiffEntry> more = {};
  std::vector<TiffImage> below = {};  // in directories that an entry points to
  bool isTiled = false;               // one tile in place of the strip: sides are multiples of 16
};

class TiffWriter {
 public:
  // The pages in turn, each with its texels after its directory; `before`: bytes after the header.
  static std::string file(const std::vector<TiffImage>& pages, const std::string& before = "") {
    TiffWriter writer;
    writer.file_ = std::string("II*\0\0\0\0\0", 8) + before;
    size_t link = 4;
    for (const TiffImage& page : pages) {
      const auto [directory, next] = writer.append(page);
      writer.set(link, directory);
      link = next;
    }
    return writer.file_;
  }

 private:
  struct Place {
    size_t directory, next;  // where the offset of the next directory is
  };

  Place append(const TiffImage& image) {
    TiffEntry below{330, 4, {}};
    for (const TiffImage& other : image.below)
      below.values.push_back(uint32_t(append(other).directory));
    std::vector<TiffEntry> entries = {{256, 4, {uint32_t(image.width)}},
                                      {257, 4, {uint32_t(image.height)}},
                                      {kBits, 3, std::vector<uint32_t>(image.samples, image.bits)},
                                      {259, 3, {image.compression}},
                                      {262, 3, {image.photometric}},
                                      {kStripOffsets, 4, {0}},
                                      {277, 3, {image.samples}},
                                      {kRowsPerStrip, 4, {uint32_t(image.height)}},
                                      {kStripLengths, 4, {uint32_t(image.texels.size())}},
                                      {339, 3, std::vector<uint32_t>(image.samples, image.format)}};
    entries.insert(entries.end(), image.more.begin(), image.more.end());
    if (!below.values.empty()) entries.push_back(below);
    if (image.isTiled) tile(entries);
    if (image.bits == 0)
      std::erase_if(entries, [](const TiffEntry& entry) { return entry.tag == kBits; });
    std::ranges::sort(entries, {}, &TiffEntry::tag);
    std::string directory = number(entries.size(), 2);
    for (const TiffEntry& entry : entries) {
      std::string values;
      const int bytes = entry.type == 7 ? 1 : entry.type == 3 ? 2 : 4;
      for (const uint32_t value : entry.values) values += number(value, bytes);
      const size_t count = entry.values.size() / (entry.type == 5 ? 2 : 1);
      if (values.size() > 4) values = number(appended(values), 4);
      values.resize(4);
      directory += number(entry.tag, 2) + number(entry.type, 2) + number(count, 4) + values;
    }
    const size_t at = appended(directory + number(0, 4));
    const uint16_t offsets = image.isTiled ? kTileOffsets : kStripOffsets;
    const size_t entry = std::ranges::find(entries, offsets, &TiffEntry::tag) - entries.begin();
    set(at + 2 + 12 * entry + 8, appended(image.texels));
    return {at, at + directory.size()};
  }

  // Entries of a strip become those of a tile of the image's size.
  static void tile(std::vector<TiffEntry>& entries) {
    for (TiffEntry& entry : entries)
      entry.tag = entry.tag == kStripOffsets   ? kTileOffsets
                  : entry.tag == kRowsPerStrip ? kTileHeight
                  : entry.tag == kStripLengths ? kTileLengths
                                               : entry.tag;
    entries.push_back({kTileWidth, 4, entries.front().values});
  }

  size_t appended(const std::string& bytes) {
    file_.resize((file_.size() + 1) / 2 * 2);
    file_ += bytes;
    return file_.size() - bytes.size();
  }
  void set(size_t at, size_t offset) { file_.replace(at, 4, number(offset, 4)); }
  static std::string number(size_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += char(value >> 8 * i & 0xff);
    return text;
  }

  static constexpr uint16_t kBits = 258, kStripOffsets = 273, kRowsPerStrip = 278,
                            kStripLengths = 279, kTileWidth = 322, kTileHeight = 323,
                            kTileOffsets = 324, kTileLengths = 325;
  std::string file_;
};

}  // namespace chromeball
