// SPDX-License-Identifier: Apache-2.0
// Portable float map: "PF" (RGB) or "Pf" (grey), rows from the bottom up, 32-bit floats. The sign
// of the scale line gives the byte order, its magnitude the factor of all texels; we write -1
// (little-endian).
#pragma once

#include <filesystem>

#include "base/message.h"
#include "image/image.h"

namespace chromeball {

// One or three channels; adds a note about a scale other than 1. Throws InputError.
Image readPfm(const std::filesystem::path& path, Messages& messages);

// Writes the first three channels, or the first one of an image with fewer. Throws RunError.
void writePfm(const std::filesystem::path& path, const Image& image);

}  // namespace chromeball
