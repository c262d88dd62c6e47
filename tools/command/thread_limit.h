// SPDX-License-Identifier: Apache-2.0
// The option --threads.
#pragma once

#include <tbb/global_control.h>

#include <optional>

#include "job/settings.h"

namespace chromeball {

// Limits the number of threads as long as it lives; 0 in the settings: no limit.
class ThreadLimit {
 public:
  explicit ThreadLimit(const Settings& settings) {
    if (const auto count = settings.get<uint64_t>("threads"))
      control_.emplace(tbb::global_control::max_allowed_parallelism, count);
  }

 private:
  std::optional<tbb::global_control> control_;
};

}  // namespace chromeball
