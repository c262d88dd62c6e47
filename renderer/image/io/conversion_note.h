// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "base/message.h"
#include "image/chromaticities.h"

namespace chromeball {

// That the colour of a file is converted to Rec. 709 from these primaries.
Message conversionNote(const std::filesystem::path& path, const Chromaticities& from);

}  // namespace chromeball
