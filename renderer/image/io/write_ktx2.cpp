// SPDX-License-Identifier: Apache-2.0
#include "image/io/write_image.h"

#include <Imath/half.h>

#include <string>

#include "base/file.h"

namespace chromeball {
namespace {

constexpr float kLargestHalf = 65504;

// Little-endian bytes.
class Bytes {
 public:
  std::string text;

  template <class Integer>
  void add(Integer value) {
    for (size_t i = 0; i < sizeof value; ++i) text += char(uint64_t(value) >> (8 * i) & 255);
  }
  void add32(std::initializer_list<uint32_t> values) {
    for (const uint32_t value : values) add(value);
  }
  void align(size_t to) { text.resize((text.size() + to - 1) / to * to); }
};

// The data format descriptor of four half floats: section 5.1 of "Khronos Data Format".
Bytes formatDescriptor() {
  constexpr uint32_t kSigned = 0x40, kFloat = 0x80, kChannels[] = {0, 1, 2, 15};  // R G B A
  constexpr uint32_t kRgbsda = 1, kBt709 = 1, kLinear = 1, kMinusOne = 0xBF800000,
                     kOne = 0x3F800000;
  Bytes bytes;
  constexpr uint32_t kBlock = 24 + 4 * 16;
  bytes.add32({kBlock + 4, 0, 2 | kBlock << 16, kRgbsda | kBt709 << 8 | kLinear << 16, 0, 8, 0});
  for (uint32_t i = 0; i < 4; ++i)
    bytes.add32({16 * i | 15u << 16 | (kChannels[i] | kSigned | kFloat) << 24, 0, kMinusOne, kOne});
  return bytes;
}

Bytes keysAndValues() {
  using namespace std::string_literals;
  Bytes bytes;
  for (const std::string& entry : {"KTXorientation\0rd\0"s, "KTXwriter\0chromeball\0"s}) {
    bytes.add(uint32_t(entry.size()));
    bytes.text += entry;
    bytes.align(4);
  }
  return bytes;
}

void addHalf(Bytes& bytes, float value, size_t& clipped) {
  clipped += std::fabs(value) > kLargestHalf;
  bytes.add(half(std::clamp(value, -kLargestHalf, kLargestHalf)).bits());
}

void addTexels(Bytes& bytes, const Image& faces, size_t& clipped) {
  for (size_t i = 0; i < faces.pixels(); ++i) {
    for (int c = 0; c < 3; ++c) addHalf(bytes, faces.at(i)[c], clipped);
    addHalf(bytes, 1, clipped);
  }
}

}  // namespace

size_t writeKtx2(const std::filesystem::path& path, const std::vector<const Image*>& levels) {
  constexpr uint32_t kRgba16Float = 97;  // VK_FORMAT_R16G16B16A16_SFLOAT
  constexpr size_t kHeader = 80, kLevelEntry = 24, kTexel = 8;
  const Bytes descriptor = formatDescriptor(), keys = keysAndValues();
  const uint32_t size = uint32_t(levels.front()->width), count = uint32_t(levels.size());
  const size_t descriptorAt = kHeader + kLevelEntry * levels.size(),
               keysAt = descriptorAt + descriptor.text.size();
  Bytes file;
  file.text = "\xABKTX 20\xBB\r\n\x1A\n";
  file.add32({kRgba16Float, 2, size, size, 0, 0, 6, count, 0});
  file.add32({uint32_t(descriptorAt), uint32_t(descriptor.text.size()), uint32_t(keysAt),
              uint32_t(keys.text.size())});
  file.add32({0, 0, 0, 0});  // no data of a supercompression

  // The smallest level comes first in the file, the largest first in the index.
  std::vector<size_t> at(levels.size());
  const size_t dataAt = (keysAt + keys.text.size() + kTexel - 1) / kTexel * kTexel;
  size_t next = dataAt;
  for (size_t i = levels.size(); i-- > 0;) {
    at[i] = next;
    next += kTexel * levels[i]->width * levels[i]->height;
  }
  for (size_t i = 0; i < levels.size(); ++i) {
    const uint64_t bytes = kTexel * levels[i]->width * levels[i]->height;
    file.add(uint64_t(at[i]));
    file.add(bytes);
    file.add(bytes);
  }
  file.text += descriptor.text + keys.text;
  file.align(kTexel);
  size_t clipped = 0;
  for (size_t i = levels.size(); i-- > 0;) addTexels(file, *levels[i], clipped);

  writeFile(path, {reinterpret_cast<const uint8_t*>(file.text.data()), file.text.size()});
  return clipped;
}

}  // namespace chromeball
