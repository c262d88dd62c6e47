// SPDX-License-Identifier: Apache-2.0
#include "base/memory.h"

#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>

namespace chromeball {

double memoryBudget() {
  double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    memory = std::min(memory, double(limit.rlim_cur));
  return 0.8 * memory;
}

void useLargePages(void* data, size_t bytes) {
  constexpr uintptr_t kLargePage = 2 << 20;
  const uintptr_t begin = (uintptr_t(data) + kLargePage - 1) / kLargePage * kLargePage;
  const uintptr_t end = (uintptr_t(data) + bytes) / kLargePage * kLargePage;
  if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

}  // namespace chromeball
