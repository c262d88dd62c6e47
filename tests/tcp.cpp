// SPDX-License-Identifier: Apache-2.0
#include "tcp.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <utility>

namespace {

sockaddr_in localAddress(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(uint16_t(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

}  // namespace

Socket::Socket(Socket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

Socket::~Socket() {
  if (descriptor_ >= 0) close(descriptor_);
}

void Socket::write(const std::string& bytes) const {
  send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

std::string Socket::read(size_t count) const {
  std::string bytes(count, '\0');
  size_t got = 0;
  while (got < count) {
    const ssize_t n = recv(descriptor_, bytes.data() + got, count - got, 0);
    if (n <= 0) break;
    got += size_t(n);
  }
  bytes.resize(got);
  return bytes;
}

Listener::Listener() : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
  sockaddr_in address = localAddress(0);
  socklen_t size = sizeof address;
  bind(socket_.descriptor(), reinterpret_cast<sockaddr*>(&address), size);
  listen(socket_.descriptor(), 4);
  getsockname(socket_.descriptor(), reinterpret_cast<sockaddr*>(&address), &size);
  port_ = ntohs(address.sin_port);
}

Socket Listener::accept() const { return Socket(::accept(socket_.descriptor(), nullptr, nullptr)); }

int freePort() { return Listener().port(); }

Socket connectTo(int port) {
  Socket socket(::socket(AF_INET, SOCK_STREAM, 0));
  const sockaddr_in address = localAddress(port);
  const int error =
      connect(socket.descriptor(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
  return error == 0 ? std::move(socket) : Socket();
}
