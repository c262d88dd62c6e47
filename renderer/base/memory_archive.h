// SPDX-License-Identifier: Apache-2.0
// Archives in memory.
#pragma once

#include <cstring>
#include <span>
#include <string>
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

// `contents` must outlive it. `name`: of the file that they are from.
class MemoryReader : public Archive {
 public:
  explicit MemoryReader(std::span<const char> contents, std::string name = "memory")
      : contents_(contents), name_(std::move(name)) {}
  bool reads() const override { return true; }
  std::string name() const override { return name_; }
  uint64_t left() const override { return contents_.size(); }

 protected:
  void bytes(void* data, size_t count) override {
    check(count <= left());
    if (count > 0) std::memcpy(data, contents_.data(), count);
    skip(count);
  }
  std::span<const char> rest() const { return contents_; }
  void skip(size_t count) { contents_ = contents_.subspan(count); }

 private:
  std::span<const char> contents_;  // that are not read yet
  std::string name_;
};

}  // namespace chromeball
