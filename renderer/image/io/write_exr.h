// SPDX-License-Identifier: Apache-2.0
// OpenEXR files with layers, attributes, and what this program reads again (exr_state.h).
#pragma once

#include <filesystem>

#include "image/io/write_image.h"

namespace chromeball {

// Writes float32 scanlines with ZIP compression, and output.state if it is set. Atomic. Throws
// RunError.
void writeExr(const std::filesystem::path& path, const OutputImage& output);

}  // namespace chromeball
