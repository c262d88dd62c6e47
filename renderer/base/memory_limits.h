// SPDX-License-Identifier: Apache-2.0
// What limits the memory of this process.
#pragma once

#include <filesystem>
#include <string>

namespace chromeball {

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
