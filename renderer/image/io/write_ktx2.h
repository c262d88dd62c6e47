// SPDX-License-Identifier: Apache-2.0
// Writes cube maps as KTX 2.0 (Khronos, "KTX File Format", version 2.0).
#pragma once

#include <filesystem>
#include <vector>

#include "image/image.h"

namespace chromeball {

// `levels`: from the largest to the smallest, each half the size of the one before, six faces one
// below another in the order +X -X +Y -Y +Z -Z. Half floats, linear Rec. 709, alpha 1, not
// compressed. Channels beyond the range of a half are set to its ends; returns how many. The file
// appears complete or not at all. Throws RunError if writing fails.
size_t writeKtx2(const std::filesystem::path& path, const std::vector<const Image*>& levels);

}  // namespace chromeball
