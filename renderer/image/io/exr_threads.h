// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace chromeball {

// Lets OpenEXR compress on all cores, unless the process has chosen a number of threads for it.
void useExrThreads();

}  // namespace chromeball
