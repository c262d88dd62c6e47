// SPDX-License-Identifier: Apache-2.0
// Portable float map: "PF" (RGB) or "Pf" (grey), rows from the bottom up, 32-bit floats. The sign
// of the scale line gives the byte order; 0 and NaN have none. Its magnitude has no agreed meaning
// and is ignored; we write -1 (little-endian).
#pragma once

#include <filesystem>

#include "image/image.h"

namespace chromeball {

// One or three channels. Throws InputError.
Image readPfm(const std::filesystem::path& path);

// Writes the first three channels, or the first one of an image with fewer. Throws RunError.
void writePfm(const std::filesystem::path& path, const Image& image);

}  // namespace chromeball
