// SPDX-License-Identifier: Apache-2.0
// The option --threads.
#pragma once

#include "base/parallel.h"
#include "front/settings.h"

namespace chromeball {

// 0 in the settings: no limit.
inline ThreadLimit threadLimit(const Settings& settings) {
  return ThreadLimit(settings.get<uint64_t>("threads"));
}

}  // namespace chromeball
