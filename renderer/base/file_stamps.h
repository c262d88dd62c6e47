// SPDX-License-Identifier: Apache-2.0
// Tells whether files have changed since they were read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace chromeball {

class FileStamps {
 public:
  using Time = std::filesystem::file_time_type;
  static Time now();

  // Files that were read from `begin` on; those that were written meanwhile count as changed.
  void add(const std::vector<std::string>& files, Time begin);

  // By path, size, node and times of the last changes, without reading it. False if it was not
  // added.
  bool isCurrent(const std::string& file) const;
  bool areCurrent() const;  // all

 private:
  struct Stamp {
    std::filesystem::path path;  // without links
    uintmax_t size;
    Time written;
    uint64_t node = 0;  // which file has this path
    int64_t changed = 0,
            nanoseconds = 0;  // of its contents or its attributes, which nobody can set

    explicit Stamp(const std::string& file);
    bool operator==(const Stamp&) const = default;
  };

  std::map<std::string, std::optional<Stamp>> stamps_;  // nullopt: counts as changed
};

}  // namespace chromeball
