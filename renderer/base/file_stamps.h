// SPDX-License-Identifier: Apache-2.0
// Tells whether files have changed since they were read.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace chromeball {

class FileStamps {
 public:
  using Time = std::chrono::nanoseconds;  // since 1970, by the clock that dates files
  static Time now();

  // Files that were read from `begin` on; those that were written meanwhile count as changed.
  void add(const std::vector<std::string>& files, Time begin);

  // By its node and the time of its last change, without reading it. False if it was not added.
  bool isCurrent(const std::string& file) const;
  bool areCurrent() const;  // all

 private:
  // Of a file without links; that of a missing one is {}.
  struct Stamp {
    uint64_t device = 0, node = 0;
    Time changed{};  // its contents or attributes; no program can set this time

    bool operator==(const Stamp&) const = default;
  };
  static Stamp stampOf(const std::string& file);

  std::map<std::string, std::optional<Stamp>> stamps_;  // nullopt: counts as changed
};

}  // namespace chromeball
