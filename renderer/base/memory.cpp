// SPDX-License-Identifier: Apache-2.0
#include "base/memory.h"

#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>

namespace chromeball {

double memoryBudget() { return 0.8 * memoryLimits().least(); }

void useLargePages(void* data, size_t bytes) {
  constexpr uintptr_t kLargePage = 2 << 20;
  const uintptr_t begin = (uintptr_t(data) + kLargePage - 1) / kLargePage * kLargePage;
  const uintptr_t end = (uintptr_t(data) + bytes) / kLargePage * kLargePage;
  if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

namespace {

namespace fs = std::filesystem;

// The groups of this process: "0::/PATH" (version 2) and "4:memory:/PATH" (version 1). The path is
// that of the host if the process sees all groups, else from the root that it sees.
double ownControlGroupLimit() {
  double least = INFINITY;
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    const size_t path = line.find(":/");
    if (path == std::string::npos) continue;
    const std::string own = line.substr(path + 2);
    if (line.starts_with("0::")) least = std::min(least, controlGroupLimit("/sys/fs/cgroup", own));
    if (line.find(":memory:") != std::string::npos)
      least = std::min(least, controlGroupLimit("/sys/fs/cgroup/memory", own));
  }
  return least;
}

}  // namespace

double MemoryLimits::least() const { return std::min({machine, addressSpace, controlGroup}); }

MemoryLimits memoryLimits() {
  rlimit limit{};
  const bool isLimited = getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
  return {.machine = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE)),
          .addressSpace = isLimited ? double(limit.rlim_cur) : INFINITY,
          .controlGroup = ownControlGroupLimit()};
}

double controlGroupLimit(const fs::path& root, const std::string& own) {
  double least = INFINITY;
  // Version 1 writes no limit as a number near 2^63.
  constexpr double kNone = 0x1p60;
  fs::path group = root / own;
  for (;; group = group.parent_path()) {
    for (const char* name : {"memory.max", "memory.limit_in_bytes"}) {
      double bytes = 0;
      if (std::ifstream(group / name) >> bytes && bytes < kNone) least = std::min(least, bytes);
    }
    if (group == root || group == group.parent_path()) return least;
  }
}

}  // namespace chromeball
