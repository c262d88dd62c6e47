// SPDX-License-Identifier: Apache-2.0
#include "viewers/tev_packet.h"

#include <bit>
#include <cstring>

namespace chromeball {
namespace {

static_assert(std::endian::native == std::endian::little);

enum class Type : char { CloseImage = 2, CreateImage = 4, UpdateImageV3 = 6 };

class PacketWriter {
 public:
  explicit PacketWriter(Type type) : bytes_(sizeof(uint32_t)) { put(type); }

  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const size_t end = bytes_.size();
    bytes_.resize(end + sizeof value);
    std::memcpy(bytes_.data() + end, &value, sizeof value);
  }
  void put(const std::string& text) {
    bytes_.insert(bytes_.end(), text.c_str(), text.c_str() + text.size() + 1);
  }
  void put(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) put(text);
  }
  void reserve(size_t more) { bytes_.reserve(bytes_.size() + more); }

  TevPacket finish() {
    const auto length = uint32_t(bytes_.size());
    std::memcpy(bytes_.data(), &length, sizeof length);
    return std::move(bytes_);
  }

 private:
  TevPacket bytes_;
};

constexpr char kGrabFocus = 1, kKeepFocus = 0;

}  // namespace

std::vector<std::string> channelNames(const OutputImage& image) {
  std::vector<std::string> names;
  for (const Layer& layer : image.layers) {
    if (layer.channels.empty()) names.push_back(layer.name);
    for (const char letter : layer.channels)
      names.push_back(layer.name.empty() ? std::string(1, letter) : layer.name + '.' + letter);
  }
  return names;
}

TevPacket closePacket(const std::string& name) {
  PacketWriter packet(Type::CloseImage);
  packet.put(name);
  return packet.finish();
}

TevPacket createPacket(const std::string& name, const OutputImage& image) {
  const std::vector<std::string> channels = channelNames(image);
  const Image& color = image.layers.front().image;
  PacketWriter packet(Type::CreateImage);
  packet.put(kGrabFocus);
  packet.put(name);
  packet.put(int32_t(color.width));
  packet.put(int32_t(color.height));
  packet.put(int32_t(channels.size()));
  packet.put(channels);
  return packet.finish();
}

TevPacket updatePacket(const std::string& name, const OutputImage& image, int top, int rows) {
  const std::vector<std::string> channels = channelNames(image);
  const int width = image.layers.front().image.width;
  PacketWriter packet(Type::UpdateImageV3);
  packet.put(kKeepFocus);
  packet.put(name);
  packet.put(int32_t(channels.size()));
  packet.put(channels);
  for (const int32_t number : {0, top, width, rows}) packet.put(number);
  for (size_t i = 0; i < channels.size(); ++i) packet.put(int64_t(i));                // offsets
  for (size_t i = 0; i < channels.size(); ++i) packet.put(int64_t(channels.size()));  // strides
  packet.reserve(size_t(rows) * size_t(width) * channels.size() * sizeof(float));
  for (int y = top; y < top + rows; ++y)
    for (int x = 0; x < width; ++x)
      for (const Layer& layer : image.layers)
        for (int c = 0; c < layer.image.channels; ++c) packet.put(layer.image.at(x, y)[c]);
  return packet.finish();
}

}  // namespace chromeball
