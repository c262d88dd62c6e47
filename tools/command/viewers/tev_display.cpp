// SPDX-License-Identifier: Apache-2.0
// The protocol for sending images to tev, the image viewer (github.com/Tom94/tev,
// include/tev/Ipc.h): the length in bytes with its own four, the type, then the fields, all
// little-endian without padding; strings end in a zero byte.
#include "viewers/tev_display.h"

#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include "base/error.h"
#include "image/io/write_image.h"
#include "messages.h"

namespace chromeball {
namespace {

using TevPacket = std::vector<char>;

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

// The names of the channels of all layers, in the order of the files that writeImage() writes: R,
// G, B, albedo.R, ...
std::vector<std::string> channelNames(const OutputImage& image) {
  std::vector<std::string> names;
  for (const Layer& layer : image.layers) {
    if (layer.channels.empty()) names.push_back(layer.name);
    for (const char letter : layer.channels)
      names.push_back(layer.name.empty() ? std::string(1, letter) : layer.name + '.' + letter);
  }
  return names;
}

// CloseImage (type 2).
TevPacket closePacket(const std::string& name) {
  PacketWriter packet(Type::CloseImage);
  packet.put(name);
  return packet.finish();
}

// CreateImage (type 4): an image of these channels, still black.
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

// UpdateImageV3 (type 6): rows [top, top + rows), with the channels interleaved.
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

constexpr std::chrono::seconds kPatience{5};

// A connected socket. Throws InputError.
int connectTo(const std::string& address) {
  const size_t colon = address.rfind(':');
  std::string host = address.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  const std::string port = colon == std::string::npos ? "" : address.substr(colon + 1);
  const bool isPort = !port.empty() && port.size() <= 5 &&
                      port.find_first_not_of("0123456789") == std::string::npos &&
                      std::stoi(port) <= 65535;
  if (host.empty() || !isPort) throwInput("--display: `{}` is not HOST:PORT", address);
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int error = getaddrinfo(host.c_str(), port.c_str(), &hints, &found); error != 0)
    throwInput("--display: {}: {}", address, gai_strerror(error));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, &freeaddrinfo);
  for (const addrinfo* one = found; one; one = one->ai_next) {
    const int socket = ::socket(one->ai_family, one->ai_socktype | SOCK_CLOEXEC, one->ai_protocol);
    if (socket < 0) continue;
    const timeval patience{.tv_sec = kPatience.count(), .tv_usec = 0};  // also for connect()
    setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    if (connect(socket, one->ai_addr, one->ai_addrlen) == 0) return socket;
    close(socket);
  }
  throwInput("--display: nothing answers at {}; start tev first", address);
}

}  // namespace

TevDisplay::TevDisplay(const std::string& address)
    : socket_(connectTo(address)), sender_([this] { run(); }) {}

TevDisplay::~TevDisplay() {
  {
    const std::scoped_lock lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, kPatience, [&] { return hasEnded_; }))
      shutdown(socket_, SHUT_RDWR);  // ends send()
  }
  sender_.join();
  close(socket_);
}

void TevDisplay::show(std::shared_ptr<const ImageSoFar> image) {
  {
    std::unique_lock lock(mutex_);
    if (waiting_ && waitingName_ != name_)  // the last image of the frame before
      changed_.wait_for(lock, kPatience, [&] { return !waiting_ || hasEnded_; });
    waiting_ = std::move(image);
    waitingName_ = name_;
    isIdle_ = false;
  }
  changed_.notify_all();
}

void TevDisplay::run() {
  std::unique_lock lock(mutex_);
  sendImages(lock);
  hasEnded_ = true;
  changed_.notify_all();
}

void TevDisplay::sendImages(std::unique_lock<std::mutex>& lock) {
  for (;;) {
    changed_.wait(lock, [&] { return waiting_ || ends_; });
    if (!waiting_) return;
    const std::shared_ptr<const ImageSoFar> image = std::move(waiting_);
    const std::string name = waitingName_;
    lock.unlock();
    changed_.notify_all();
    const bool arrived = send(name, image->image);
    lock.lock();
    if (!arrived) {
      warn("tev has ended, or takes no images any more; the render goes on without it");
      return;  // isIdle_ remains false: no image is wanted
    }
    isIdle_ = !waiting_;
  }
}

// False if the viewer does not take it.
bool TevDisplay::send(const std::string& name, const OutputImage& image) {
  constexpr size_t kPacketBytes = size_t(4) << 20;
  Sent next{name, channelNames(image)};
  if (next != last_) {
    if (last_.name == name && !send(closePacket(name))) return false;
    last_ = std::move(next);
    if (!send(createPacket(name, image))) return false;
  }
  const Image& color = image.layers.front().image;
  const size_t rowBytes = size_t(color.width) * last_.channels.size() * sizeof(float);
  const int rows = int(std::clamp<size_t>(kPacketBytes / rowBytes, 1, size_t(color.height)));
  for (int top = 0; top < color.height; top += rows)
    if (!send(updatePacket(name, image, top, std::min(rows, color.height - top)))) return false;
  return true;
}

bool TevDisplay::send(const std::vector<char>& packet) {
  for (size_t sent = 0; sent < packet.size();) {
    const ssize_t count = ::send(socket_, packet.data() + sent, packet.size() - sent, MSG_NOSIGNAL);
    if (count <= 0) return false;
    sent += size_t(count);
  }
  return true;
}

}  // namespace chromeball
