// SPDX-License-Identifier: Apache-2.0
#include "image/io/exr_metadata.h"

#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfEnvmapAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenEXR/OpenEXRConfig.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/error.h"

namespace chromeball {
namespace {

bool saysHowItIsStored(std::string_view name) {
  constexpr std::string_view kNames[] = {"type", "version", "chunkCount", "maxSamplesPerPixel"};
  return std::find(std::begin(kNames), std::end(kNames), name) != std::end(kNames);
}

template <class T>
const T* typed(const Imf::Attribute& attribute) {
  const auto* found = dynamic_cast<const Imf::TypedAttribute<T>*>(&attribute);
  return found ? &found->value() : nullptr;
}

namespace fs = std::filesystem;

using Bytes = std::vector<char>;

// Bytes of an attribute of each type of fixed length.
const std::map<std::string, size_t> kLengths = {
    {"box2f", 16},      {"box2i", 16},   {"chromaticities", 32},
    {"compression", 1}, {"double", 8},   {"envmap", 1},
    {"float", 4},       {"int", 4},      {"keycode", 28},
    {"lineOrder", 1},   {"m33d", 72},    {"m33f", 36},
    {"m44d", 128},      {"m44f", 64},    {"rational", 8},
    {"tiledesc", 9},    {"timecode", 8}, {"v2d", 16},
    {"v2f", 8},         {"v2i", 8},      {"v3d", 24},
    {"v3f", 12},        {"v3i", 12},     {"deepImageState", 1}};

// Rows that are compressed together, by compression: none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A,
// DWAA, DWAB.
constexpr std::array kRowsOfBlock = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};

// The number of channels in a channel list, in which each is a name that ends with 0, then 16
// bytes; an empty name ends the list. 0 if the list and its attribute do not end at the same byte.
int64_t channelsIn(const Bytes& list) {
  int64_t channels = 0;
  size_t at = 0;
  for (; at < list.size() && list[at] != 0; ++channels)
    at += strnlen(list.data() + at, list.size() - at) + 1 + 16;
  return at + 1 == list.size() ? channels : 0;
}

// Whether the content is a sequence of strings, each after its length.
bool isStringVector(const Bytes& list) {
  size_t at = 0;
  while (list.size() - at >= sizeof(uint32_t)) {
    uint32_t length;
    std::memcpy(&length, list.data() + at, sizeof(length));
    at += sizeof(length);
    if (length > list.size() - at) return false;
    at += length;
  }
  return at == list.size();
}

// The type of an attribute decides how many bytes the library reads, not the length that the file
// states. Only if both agree does ExrHeaders see the same attributes as the library.
bool hasLengthOfType(const std::string& type, const Bytes& content) {
  if (const auto found = kLengths.find(type); found != kLengths.end())
    return content.size() == found->second;
  if (type == "chlist") return channelsIn(content) > 0;
  if (type == "stringvector") return isStringVector(content);
  if (type == "floatvector") return content.size() % sizeof(float) == 0;
  return true;
}

// When OpenEXR opens a file, it allocates the stated length of each attribute and buffers for whole
// rows of blocks: gigabytes for a file of 400 bytes. So these sizes are checked first.
class ExrHeaders {
 public:
  ExrHeaders(const fs::path& path, uint64_t maxNumbers)
      : path_(path),
        maxNumbers_(maxNumbers),
        in_(path, std::ios::binary),
        left_(int64_t(fs::file_size(path))) {}

  int check() {
    constexpr uint32_t kMultiPart = 0x1000;
    number<uint32_t>();  // magic
    const bool multiPart = number<uint32_t>() & kMultiPart;
    do checkPart();
    while (multiPart && in_.peek() != 0 && left_ > 0);
    return maxRowsOfBlock_;
  }

 private:
  void checkPart() {
    int64_t width = 1, height = 1, channels = 1;
    int rowsOfBlock = 1;
    for (std::string name = word(); !name.empty(); name = word()) {
      const std::string type = word();
      const Bytes content = bytes(number<int32_t>());
      if (!hasLengthOfType(type, content))
        throwInput("{}: damaged header: it has a {} of {} bytes", path_.string(),
                   kLengths.contains(type) ? type : "list", content.size());
      if (type == "box2i" && name == "dataWindow") {
        int32_t box[4];  // first column, first row, last column, last row
        std::memcpy(box, content.data(), sizeof(box));
        width = int64_t(box[2]) - box[0] + 1;
        height = int64_t(box[3]) - box[1] + 1;
      } else if (type == "tiledesc" && name == "tiles") {
        uint32_t tile[2];
        std::memcpy(tile, content.data(), sizeof(tile));
        checkSide(tile[0]);
        checkSide(tile[1]);
        checkImageSize(path_, tile[0], tile[1], channels);
      } else if (type == "chlist" && name == "channels") {
        channels = channelsIn(content);
      } else if (type == "compression" && name == "compression" &&
                 size_t(content[0]) < kRowsOfBlock.size()) {
        rowsOfBlock = kRowsOfBlock[size_t(content[0])];
      }
    }
    checkImageSize(path_, width, height, channels, maxNumbers_);
    checkImageSize(path_, width, rowsOfBlock, channels);
    checkSide(width);
    maxRowsOfBlock_ = std::max(maxRowsOfBlock_, rowsOfBlock);
  }

  void checkSide(int64_t side) const {
    constexpr int64_t kMaxSide = 1 << 17;  // a row of blocks is at most 256 texels high
    if (side > kMaxSide)
      throwInput("{}: {} texels per row exceed the limit of {}", path_.string(), side, kMaxSide);
  }

  Bytes bytes(int64_t count) {
    if (count < 0 || count > left_)
      throwInput("{}: damaged header: it claims more bytes than the file has", path_.string());
    left_ -= count;
    Bytes content(count);
    if (!in_.read(content.data(), count))
      throwInput("{}: cannot read the whole file", path_.string());
    return content;
  }

  template <class Number>
  Number number() {
    Number n;
    std::memcpy(&n, bytes(sizeof(n)).data(), sizeof(n));
    return n;
  }

  std::string word() {
    constexpr size_t kMaxLength = 255;
    std::string text;
    for (char c = bytes(1)[0]; c != 0; c = bytes(1)[0]) {
      text += c;
      if (text.size() > kMaxLength)
        throwInput("{}: damaged header: a name in it does not end", path_.string());
    }
    return text;
  }

  fs::path path_;
  uint64_t maxNumbers_;
  int maxRowsOfBlock_ = 1;
  std::ifstream in_;
  int64_t left_;
};

}  // namespace

std::string exrVersion() { return OPENEXR_VERSION_STRING; }

Metadata metadataOf(const Imf::Header& header) {
  Metadata metadata;
  for (auto at = header.begin(); at != header.end(); ++at) {
    const std::string name = at.name();
    const Imf::Attribute& attribute = at.attribute();
    if (saysHowItIsStored(name)) continue;
    if (const auto* text = typed<std::string>(attribute)) {
      if (!text->empty()) metadata[name] = *text;
    } else if (const int* integer = typed<int>(attribute)) {
      metadata[name] = *integer;
    } else if (const float* number = typed<float>(attribute)) {
      metadata[name] = *number;
    } else if (const double* precise = typed<double>(attribute)) {
      metadata[name] = *precise;
    } else if (const auto* matrix = typed<Imath::M44f>(attribute)) {
      std::copy_n(matrix->getValue(), 16, std::get<Matrix44>(metadata[name] = Matrix44{}).begin());
    } else if (const auto* envmap = typed<Imf::Envmap>(attribute)) {
      if (*envmap == Imf::ENVMAP_LATLONG) metadata[name] = std::string(kEnvmapLatLong);
      if (*envmap == Imf::ENVMAP_CUBE) metadata[name] = std::string(kEnvmapCube);
    }
  }
  return metadata;
}

std::optional<Chromaticities> chromaticitiesOf(const Imf::Header& header) {
  for (auto at = header.begin(); at != header.end(); ++at)
    if (const auto* found = typed<Imf::Chromaticities>(at.attribute());
        found && std::string_view(at.name()) == "chromaticities") {
      const auto xy = [](const Imath::V2f& v) { return glm::dvec2(v.x, v.y); };
      return Chromaticities{xy(found->red), xy(found->green), xy(found->blue), xy(found->white)};
    }
  return {};
}

void setMetadata(const Metadata& metadata, Imf::Header& header) {
  for (const auto& [name, contents] : metadata) {
    if (saysHowItIsStored(name) || name == kCaptureDate) continue;
    if (const auto* matrix = std::get_if<Matrix44>(&contents)) {
      Imath::M44f m;
      std::copy(matrix->begin(), matrix->end(), m.getValue());
      header.insert(name, Imf::M44fAttribute(m));
    } else if (const auto* text = std::get_if<std::string>(&contents)) {
      if (name == kEnvmapAttribute && *text == kEnvmapCube)
        header.insert(name, Imf::EnvmapAttribute(Imf::ENVMAP_CUBE));
      else if (name == kEnvmapAttribute && *text == kEnvmapLatLong)
        header.insert(name, Imf::EnvmapAttribute(Imf::ENVMAP_LATLONG));
      else
        header.insert(name, Imf::StringAttribute(*text));
    } else if (const auto* number = std::get_if<float>(&contents)) {
      header.insert(name, Imf::FloatAttribute(*number));
    } else if (const auto* precise = std::get_if<double>(&contents)) {
      header.insert(name, Imf::DoubleAttribute(*precise));
    } else {
      header.insert(name, Imf::IntAttribute(std::get<int>(contents)));
    }
  }
}

int checkExrHeaders(const fs::path& path, uint64_t maxNumbers) {
  return ExrHeaders(path, maxNumbers).check();
}

void useExrThreads() {
  [[maybe_unused]] static const bool once = [] {
    if (Imf::globalThreadCount() == 0)
      Imf::setGlobalThreadCount(int(std::thread::hardware_concurrency()));
    return true;
  }();
}

}  // namespace chromeball
