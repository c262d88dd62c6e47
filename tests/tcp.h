// SPDX-License-Identifier: Apache-2.0
// Connections on this machine, byte by byte.
#pragma once

#include <string>

class Socket {
 public:
  explicit Socket(int descriptor = -1) : descriptor_(descriptor) {}
  Socket(Socket&& other) noexcept;
  ~Socket();

  bool isOpen() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }

  void write(const std::string& bytes) const;
  std::string read(size_t count) const;  // fewer bytes where the other side ends

 private:
  int descriptor_;
};

// Accepts connections at a port of its own.
class Listener {
 public:
  Listener();
  int port() const { return port_; }
  Socket accept() const;

 private:
  Socket socket_;
  int port_ = 0;
};

int freePort();

// Not open if nothing listens.
Socket connectTo(int port);
