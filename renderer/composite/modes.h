// SPDX-License-Identifier: Apache-2.0
// How a composite is made.
#pragma once

namespace chromeball {

enum class CompositeMode { Difference, Ratio, ShadowCatcher };  // compose.h

enum class Passes {
  One,  // both worlds along shared paths (differential.h)
  Two,  // two independent renders, subtracted: slow, as a reference
};

}  // namespace chromeball
