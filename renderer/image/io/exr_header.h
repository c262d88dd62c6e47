// SPDX-License-Identifier: Apache-2.0
// The headers of an OpenEXR file, checked before the library believes them.
#pragma once

#include <filesystem>

namespace chromeball {

// Throws InputError where an attribute is longer than the file, or a part's image or one of its
// tiles is larger than an image may be.
void checkExrHeaders(const std::filesystem::path& path);

}  // namespace chromeball
