// SPDX-License-Identifier: Apache-2.0
#include "base/tbb_version.h"

#include <tbb/version.h>

namespace chromeball {

std::string tbbVersion() { return TBB_runtime_version(); }

}  // namespace chromeball
