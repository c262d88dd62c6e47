// SPDX-License-Identifier: Apache-2.0
#include "image/io/exr_input.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfRgbaFile.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string_view>
#include <tuple>

#include "base/error.h"
#include "base/file.h"
#include "base/progress.h"
#include "image/io/color_channels.h"
#include "image/io/exr_metadata.h"
#include "image/io/image_format.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

// The placement of a data window in the display window; none if they are the same.
std::optional<Placement> placementOf(const Imath::Box2i& data, const Imath::Box2i& display) {
  const auto length = [](int min, int max) {
    return int(std::clamp<int64_t>(int64_t(max) - min + 1, 0, std::numeric_limits<int>::max()));
  };
  const auto offset = [](int from, int to) {
    constexpr int64_t kMost = std::numeric_limits<int>::max();
    return int(std::clamp<int64_t>(int64_t(to) - from, -kMost, kMost));
  };
  if (data == display) return {};
  return Placement{offset(display.min.x, data.min.x), offset(display.min.y, data.min.y),
                   length(display.min.x, display.max.x), length(display.min.y, display.max.y)};
}

// Sorts layer by layer; in each, R, G, B and A come first, then the others by name.
void sortChannels(std::vector<std::string>& channels) {
  const auto key = [](std::string_view channel) {
    const size_t dot = channel.rfind('.') + 1;  // 0: none
    const std::string_view letter = channel.substr(dot);
    const size_t rank = letter.size() == 1 ? std::string_view("RGBA").find(letter) : letter.npos;
    return std::tuple(channel.substr(0, dot), rank, letter);
  };
  std::sort(channels.begin(), channels.end(),
            [&](const auto& a, const auto& b) { return key(a) < key(b); });
}

// Whether the channels are luminance and chroma; the chroma has half the resolution (ImfRgba.h).
bool isLuminanceChroma(const Imf::ChannelList& channels) {
  const auto has = [&](const char* name) { return channels.findChannel(name) != nullptr; };
  int count = 0;
  for (auto at = channels.begin(); at != channels.end(); ++at) ++count;
  return has("Y") && has("RY") && has("BY") && (count == 3 || (count == 4 && has("A")));
}

ExrInput::Numbers numbersOf(const Imf::ChannelList& channels) {
  std::set<Imf::PixelType> types;
  for (auto at = channels.begin(); at != channels.end(); ++at) types.insert(at.channel().type);
  if (types.size() != 1) return ExrInput::Numbers::Mixed;
  return *types.begin() == Imf::HALF    ? ExrInput::Numbers::Half
         : *types.begin() == Imf::FLOAT ? ExrInput::Numbers::Float
                                        : ExrInput::Numbers::Integer;
}

uint64_t bytesPerTexel(const Imf::ChannelList& channels) {
  uint64_t bytes = 0;
  for (auto at = channels.begin(); at != channels.end(); ++at)
    bytes += at.channel().type == Imf::HALF ? 2 : 4;
  return bytes;
}

}  // namespace

// The channels as stored: luminance and chroma, if any, not the colour that they encode.
std::vector<std::string> channelsOf(const Imf::ChannelList& channels) {
  std::vector<std::string> names;
  if (isLuminanceChroma(channels)) {
    names = {"R", "G", "B"};
    if (channels.findChannel("A")) names.emplace_back("A");
    return names;
  }
  for (auto at = channels.begin(); at != channels.end(); ++at) names.emplace_back(at.name());
  sortChannels(names);
  return names;
}

bool isDeep(const Imf::Header& header) {
  return header.hasType() && Imf::isDeepData(header.type());
}

class ExrInput::Part {
 public:
  explicit Part(const fs::path& path) : path_(path), file_(path.c_str()) {}

  // Every part's channels; none for deep parts.
  std::vector<PartChannels> parts() const {
    std::vector<PartChannels> parts(size_t(file_.parts()));
    for (int i = 0; i < file_.parts(); ++i) {
      const Imf::Header& header = file_.header(i);
      if (file_.parts() > 1 && header.hasName()) parts[size_t(i)].name = header.name();
      if (!isDeep(header)) parts[size_t(i)].channels = channelsOf(header.channels());
    }
    return parts;
  }
  void select(size_t part) { selected_ = int(part); }
  size_t selected() const { return size_t(selected_); }
  const Imf::Header& header() const { return file_.header(selected_); }

  void read(int top, int count, const std::vector<std::string>& channels, float* texels) {
    const Imath::Box2i window = header().dataWindow();
    const int first = window.min.y + top, last = first + count - 1;
    if (isLuminanceChroma(header().channels())) return readColor(first, last, channels, texels);
    const size_t width = size_t(window.max.x) - size_t(window.min.x) + 1;
    const size_t stride = channels.size() * sizeof(float);
    // OpenEXR addresses the texel (x, y) of the window by base + x * stride + y * row. The base of
    // a window far from 0 is no address, so it is a number.
    const ptrdiff_t offset = (ptrdiff_t(width) * first + window.min.x) * ptrdiff_t(stride);
    Imf::FrameBuffer buffer;
    for (size_t c = 0; c < channels.size(); ++c) {
      char* base =
          reinterpret_cast<char*>(reinterpret_cast<uintptr_t>(texels + c) - uintptr_t(offset));
      buffer.insert(channels[c], Imf::Slice(Imf::FLOAT, base, stride, stride * width));
    }
    if (!part_) part_.emplace(file_, selected_);
    part_->setFrameBuffer(buffer);
    part_->readPixels(first, last);
  }

 private:
  void readColor(int first, int last, const std::vector<std::string>& channels, float* texels) {
    if (!rgba_) rgba_.emplace(path_.c_str());
    const Imath::Box2i window = rgba_->dataWindow();
    const size_t width = size_t(window.max.x) - size_t(window.min.x) + 1;
    std::vector<Imf::Rgba> rows(width * size_t(last - first + 1));
    rgba_->setFrameBuffer(rows.data() - (ptrdiff_t(width) * first + window.min.x), 1, width);
    rgba_->readPixels(first, last);
    for (const Imf::Rgba& texel : rows) {
      const float rgba[] = {texel.r, texel.g, texel.b, texel.a};
      texels = std::copy_n(rgba, channels.size(), texels);
    }
  }

  fs::path path_;
  Imf::MultiPartInputFile file_;
  int selected_ = 0;
  std::optional<Imf::InputPart> part_;
  std::optional<Imf::RgbaInputFile> rgba_;
};

ExrInput::ExrInput(const fs::path& path, uint64_t maxNumbers) : path_(path) {
  checkReadable(path);
  rowsOfBlock_ = checkExrHeaders(path, maxNumbers);
  useExrThreads();
  readByLibrary(path, [&] {
    part_ = std::make_unique<Part>(path);
    readHeader();
  });
}

ExrInput::ExrInput(ExrInput&&) noexcept = default;
ExrInput::~ExrInput() = default;

void ExrInput::readHeader() {
  const std::vector<PartChannels> parts = part_->parts();
  if (const auto color = findColorChannels(parts)) {
    part_->select(color->part);
    if (!color->layer.empty() && !color->others.empty())
      addNote(contents_.messages, "{}: its colour is that of `{}`, of {} layers with colour",
              path_.string(), color->layer, color->others.size() + 1);
  }
  contents_.part = parts[part_->selected()].name;
  const Imf::Header& header = part_->header();
  if (isDeep(header)) throwUnreadable(path_, "deep and volume images are not supported");
  const Imath::Box2i window = header.dataWindow();
  width_ = window.max.x - window.min.x + 1;
  height_ = window.max.y - window.min.y + 1;
  isTiled_ = header.hasTileDescription();
  numbers_ = numbersOf(header.channels());
  contents_.metadata = metadataOf(header);
  contents_.placement = placementOf(window, header.displayWindow());
  contents_.primaries = chromaticitiesOf(header);
  pixelAspectRatio_ = header.pixelAspectRatio();
  checkFileLength(path_, width_, height_,
                  uint64_t(width_) * uint64_t(height_) * bytesPerTexel(header.channels()),
                  fs::file_size(path_), kMaxUnknownRatio);
  contents_.channels = channelsOf(header.channels());
  if (isLuminanceChroma(header.channels())) {
    if (parts.size() > 1)
      throwUnreadable(path_, "luminance and chroma in one of several parts are not supported");
    if (numbers_ != Numbers::Half)  // the library's converter has no other
      throwUnreadable(path_,
                      "luminance and chroma (Y, RY, BY) are read of 16 bits only, not of 32, which "
                      "would be rounded, and infinite above 65504: store R, G and B");
    return;
  }
  for (auto at = header.channels().begin(); at != header.channels().end(); ++at)
    if (at.channel().xSampling != 1 || at.channel().ySampling != 1)
      throwUnreadable(path_, fmt::format("the channel {} does not have all texels", at.name()));
}

void ExrInput::read(int top, int count, float* texels) {
  // The size of a chunk of whole blocks; so many texels are decoded in some milliseconds.
  constexpr int kTexels = 1 << 19;
  const int blocks = std::max(kTexels / (width_ * rowsOfBlock_), 1);
  readByLibrary(path_, [&] {
    forParts(size_t(count), size_t(blocks) * size_t(rowsOfBlock_), [&](size_t begin, size_t end) {
      part_->read(top + int(begin), int(end - begin), channels(),
                  texels + begin * size_t(width_) * channels().size());
    });
  });
}

}  // namespace chromeball
