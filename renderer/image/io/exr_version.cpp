// SPDX-License-Identifier: Apache-2.0
#include "image/io/exr_version.h"

#include <OpenEXR/OpenEXRConfig.h>

namespace chromeball {

std::string exrVersion() { return OPENEXR_VERSION_STRING; }

}  // namespace chromeball
