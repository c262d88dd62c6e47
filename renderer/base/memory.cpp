// SPDX-License-Identifier: Apache-2.0
#include "base/memory.h"

#include <sys/mman.h>

#include <cstdint>

#include "base/memory_limits.h"

namespace chromeball {

double memoryBudget() { return 0.8 * memoryLimits().least(); }

void useLargePages(void* data, size_t bytes) {
  constexpr uintptr_t kLargePage = 2 << 20;
  const uintptr_t begin = (uintptr_t(data) + kLargePage - 1) / kLargePage * kLargePage;
  const uintptr_t end = (uintptr_t(data) + bytes) / kLargePage * kLargePage;
  if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

}  // namespace chromeball
