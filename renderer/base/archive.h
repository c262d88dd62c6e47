// SPDX-License-Identifier: Apache-2.0
// Objects as bytes, for files that this program reads again. One function of a class, archive(),
// both writes its members and reads them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/hash.h"

namespace chromeball {

class Archive {
 public:
  virtual ~Archive() = default;

  virtual bool reads() const = 0;
  virtual std::string name() const { return {}; }  // of the file that is read
  virtual uint64_t left() const { return 0; }      // its bytes that are not read yet
  // What a damaged file would do otherwise must be checked after reading. Throws InputError.
  void check(bool holds) const {
    if (reads() && !holds) throwInput("{}: damaged: its parts do not fit together", name());
  }

  template <class T>
  requires(std::is_trivially_copyable_v<T> && !std::is_enum_v<T>) void operator()(T& value) {
    transfer(&value, sizeof(value));
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
    transfer(items.data(), count * sizeof(T));
  }

  // Of objects with archive().
  template <class T>
  requires requires(T& t, Archive& a) { t.archive(a); }
  void operator()(std::vector<T>& items) {
    uint64_t count = items.size();
    (*this)(count);
    if (reads()) items.clear();
    for (uint64_t i = 0; i < count; ++i) {
      if (reads()) items.emplace_back();  // one by one: the number may be wrong
      items[i].archive(*this);
    }
  }

  void operator()(bool& flag) {
    uint8_t value = flag;
    transfer(&value, sizeof(value));
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
    transfer(text.data(), count);
  }

  // A list whose number of items is known before it is read.
  template <class T>
  void fixed(std::vector<T>& items) {
    const size_t count = items.size();
    (*this)(items);
    check(items.size() == count);
  }

  // A checksum of what lies between these two calls.
  void startSum() { sum_ = 1; }
  void endSum() {
    uint64_t sum = std::exchange(sum_, 0);
    const uint64_t own = sum;
    (*this)(sum);
    if (sum != own) throwInput("{}: damaged: its checksum is wrong", name());
  }

 protected:
  virtual void bytes(void* data, size_t count) = 0;

 private:
  void transfer(void* data, size_t count) {
    bytes(data, count);
    if (sum_ == 0) return;
    const auto* byte = static_cast<const unsigned char*>(data);
    for (size_t i = 0; i < count; ++i) sum_ = hash(sum_ ^ byte[i]) | 1;
  }

  uint64_t sum_ = 0;  // 0: not wanted
};

}  // namespace chromeball
