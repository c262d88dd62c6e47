// SPDX-License-Identifier: Apache-2.0
// Archives in memory.
#pragma once

#include <cstring>
#include <vector>

#include "base/archive.h"

namespace chromeball {

class MemoryWriter : public Archive {
 public:
  bool reads() const override { return false; }
  std::vector<char> contents;

 protected:
  void bytes(void* data, size_t count) override {
    const char* from = static_cast<const char*>(data);
    contents.insert(contents.end(), from, from + count);
  }
};

class MemoryReader : public Archive {
 public:
  explicit MemoryReader(const std::vector<char>& contents) : contents_(contents) {}
  bool reads() const override { return true; }
  std::string name() const override { return "memory"; }
  uint64_t left() const override { return contents_.size() - at_; }

 protected:
  void bytes(void* data, size_t count) override {
    check(count <= left());
    if (count > 0) std::memcpy(data, contents_.data() + at_, count);
    at_ += count;
  }

 private:
  const std::vector<char>& contents_;
  size_t at_ = 0;
};

}  // namespace chromeball
