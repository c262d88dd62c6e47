// SPDX-License-Identifier: Apache-2.0
// How long work reports how far it is.
#pragma once

#include <functional>

namespace chromeball {

// Called now and then with the fraction of the work that is done, in [0, 1]; NaN where that is not
// known.
using Progress = std::function<void(double)>;

}  // namespace chromeball
