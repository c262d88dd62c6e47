// SPDX-License-Identifier: Apache-2.0
#include "viewers/tev_display.h"

#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>

#include "base/error.h"
#include "messages.h"
#include "viewers/tev_packet.h"

namespace chromeball {
namespace {

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
    const std::scoped_lock lock(mutex_);
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
