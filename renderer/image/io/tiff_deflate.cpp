// SPDX-License-Identifier: Apache-2.0
#include "image/io/tiff_deflate.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>

#include "image/io/tiff_block.h"
#include "image/size_limits.h"

namespace chromeball {
namespace {

class Inflater {
 public:
  Inflater() {
    if (inflateInit(&stream_) != Z_OK) throw std::runtime_error("zlib does not start");
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;

  // Whether the block is undamaged as far as `budget`, a number of bytes, which what it inflates to
  // reduces.
  bool isSound(std::span<const uint8_t> block, double& budget) {
    inflateReset(&stream_);
    stream_.next_in = const_cast<uint8_t*>(block.data());
    stream_.avail_in = uInt(block.size());
    int state = Z_OK;
    while (state == Z_OK && budget > 0) {
      stream_.next_out = inflated_.data();
      stream_.avail_out = uInt(inflated_.size());
      state = inflate(&stream_, Z_NO_FLUSH);
      budget -= double(inflated_.size() - stream_.avail_out);
    }
    return state != Z_DATA_ERROR && state != Z_NEED_DICT;
  }

 private:
  z_stream stream_{};
  std::array<uint8_t, 1 << 15> inflated_;
};

}  // namespace

void checkDeflate(std::span<const uint8_t> file) {
  const TiffBlock tiff(file);
  const uint64_t image = tiff.firstDirectory();
  const auto number = [&](uint16_t tag) { return tiff.find(image, tag).value_or(1); };
  constexpr uint16_t kWidth = 256, kHeight = 257, kBits = 258, kCompression = 259, kSamples = 277;
  constexpr double kAdobeDeflate = 8, kDeflate = 32946;
  if (number(kCompression) != kAdobeDeflate && number(kCompression) != kDeflate) return;
  // Tiles reach beyond the image, small ones less than a small image's.
  constexpr double kAlwaysAllowed = 64 << 20, kTilesOfImage = 4;
  double outBudget = kAlwaysAllowed + kTilesOfImage * number(kWidth) * number(kHeight) *
                                          number(kSamples) * number(kBits) / 8;
  uint64_t inBudget = file.size();
  Inflater inflater;
  for (const auto& [offsetTag, lengthTag] : {std::pair(273, 279), {324, 325}}) {  // strips, tiles
    const std::vector<uint64_t> offsets = tiff.integers(image, uint16_t(offsetTag)),
                                lengths = tiff.integers(image, uint16_t(lengthTag));
    std::set<uint64_t> seen;  // blocks may be shared
    for (size_t i = 0; i < std::min(offsets.size(), lengths.size()); ++i) {
      const uint64_t offset = offsets[i], length = lengths[i];
      if (offset > file.size() || length > file.size() - offset || !seen.insert(offset).second)
        continue;
      if (length > inBudget) return;
      inBudget -= length;
      if (!inflater.isSound(file.subspan(offset, length), outBudget))
        throw std::runtime_error(fmt::format(
            "block {} of its texels is damaged: Deflate's checksum or code is wrong", i + 1));
    }
  }
}

}  // namespace chromeball
