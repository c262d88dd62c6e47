// SPDX-License-Identifier: Apache-2.0
// How much memory the process may use.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/progress.h"

namespace chromeball {

// 0.8 times the machine's memory, or the process's limit if that is less. Bytes.
double memoryBudget();

// Memory of long arrays, in large pages.

// Asks the system for pages of 2 MB in [data, data + bytes), memory that nothing was written to:
// giving out, and clearing, many pages of 4 KB takes longer than copying a file into them. Has no
// effect where the system has no such pages.
void useLargePages(void* data, size_t bytes);

inline constexpr size_t kZeroedAtOnce = 8 << 20;  // bytes; some milliseconds

// Makes room for `count` items in an empty array.
template <class T>
void reserveLong(std::vector<T>& array, size_t count) {
  array.reserve(count);
  useLargePages(array.data(), count * sizeof(T));
}

// `count` zeros.
template <class T>
std::vector<T> longArray(size_t count) {
  std::vector<T> array;
  reserveLong(array, count);
  forParts(count, kZeroedAtOnce / sizeof(T), [&](size_t, size_t end) { array.resize(end); });
  return array;
}

// What limits the memory of this process.

// Bytes; infinite where there is no limit.
struct MemoryLimits {
  double machine;       // all that it has
  double addressSpace;  // RLIMIT_AS
  double controlGroup;  // of Linux, which containers and batch systems set

  double least() const;
};
MemoryLimits memoryLimits();

// The least of the limits of a control group, `own`, and of the groups that contain it. `root` is
// where the groups are mounted: a folder with `memory.max` each (version 2), or with
// `memory.limit_in_bytes` (version 1).
double controlGroupLimit(const std::filesystem::path& root, const std::string& own);

}  // namespace chromeball
