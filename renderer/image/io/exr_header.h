// SPDX-License-Identifier: Apache-2.0
// Checks the headers of an OpenEXR file before the library reads them.
#pragma once

#include <filesystem>

namespace chromeball {

// Throws InputError if an attribute is longer than the file or of the wrong length for its type, or
// if the image or the tile size of a part exceeds the limits (size_limits.h).
void checkExrHeaders(const std::filesystem::path& path);

}  // namespace chromeball
