// SPDX-License-Identifier: Apache-2.0
// Reports the progress of long work.
#pragma once

#include <functional>

namespace chromeball {

// Called from time to time with the fraction of the work done, in [0, 1]; NaN if unknown.
using Progress = std::function<void(double)>;

}  // namespace chromeball
