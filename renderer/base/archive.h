// SPDX-License-Identifier: Apache-2.0
// Objects as bytes, for files that this program reads again. One function of a class, archive(),
// both writes its members and reads them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "base/error.h"

namespace chromeball {

class Archive {
 public:
  virtual ~Archive() = default;

  virtual bool reads() const = 0;
  virtual std::string name() const { return {}; }  // of the file that is read
  virtual uint64_t left() const { return 0; }      // its bytes that are not read yet
  // Other effects of a damaged file must be checked after reading. Throws InputError.
  void check(bool holds) const {
    if (reads() && !holds) throwDamaged();
  }

  template <class T>
  requires(std::is_trivially_copyable_v<T> && !std::is_enum_v<T>) void operator()(T& value) {
    bytes(&value, sizeof(value));
  }

  template <class T>
  requires std::is_trivially_copyable_v<T>
  void operator()(std::vector<T>& items) {
    uint64_t count = items.size();
    (*this)(count);
    if (reads()) {
      check(count <= left() / sizeof(T));  // before it is allocated
      items.resize(count);
    }
    bytes(items.data(), count * sizeof(T));
  }

  // Texts, or objects with archive().
  template <class T>
  requires(!std::is_trivially_copyable_v<T>) void operator()(std::vector<T>& items) {
    uint64_t count = items.size();
    (*this)(count);
    if (reads()) items.clear();
    for (uint64_t i = 0; i < count; ++i) {
      if (reads()) items.emplace_back();  // one by one: the number may be wrong
      if constexpr (std::is_same_v<T, std::string>)
        (*this)(items[i]);
      else
        items[i].archive(*this);
    }
  }

  void operator()(bool& flag) {
    uint8_t value = flag;
    bytes(&value, sizeof(value));
    check(value <= 1);
    flag = value == 1;
  }

  // An enum with the values 0 to `last`.
  template <class T>
  requires std::is_enum_v<T>
  void enumerator(T& value, T last) {
    auto number = uint32_t(value);
    (*this)(number);
    check(number <= uint32_t(last));
    value = T(number);
  }

  void operator()(std::string& text) {
    uint64_t count = text.size();
    (*this)(count);
    if (reads()) {
      check(count <= left());
      text.resize(count);
    }
    bytes(text.data(), count);
  }

  // Only the items; their number is known before they are read.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void items(std::span<T> list) { itemBytes(list.data(), list.size(), sizeof(T)); }

  // Blocks of a large object, which files store apart from the rest and in any order: `block` is
  // called for each index below `count`, by several threads at once.
  virtual void blocks(size_t count, const std::function<void(Archive&, size_t)>& block) {
    for (size_t i = 0; i < count; ++i) block(*this, i);
  }

  // A list whose number of items is known before it is read.
  template <class T>
  void fixed(std::vector<T>& items) {
    const size_t count = items.size();
    (*this)(items);
    check(items.size() == count);
  }

 protected:
  [[noreturn]] void throwDamaged() const {
    throwInput("{}: damaged: its parts do not fit together", name());
  }
  virtual void bytes(void* data, size_t count) = 0;
  // `count` items of `size` bytes each.
  virtual void itemBytes(void* data, size_t count, size_t size) { bytes(data, count * size); }
};

// Archives in memory.

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

// `contents` must outlive it. `name`: the file that they are from.
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
