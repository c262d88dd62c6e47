// SPDX-License-Identifier: Apache-2.0
// Checks the headers of an OpenEXR file before the library reads them.
#pragma once

#include <filesystem>

#include "image/size_limits.h"

namespace chromeball {

// Throws InputError if an attribute is longer than the file or of the wrong length for its type, or
// if a part exceeds the limits (size_limits.h): its image `maxNumbers`, its tiles or the rows that
// are compressed together kMaxImageFloats. Returns the largest number of rows that are compressed
// together.
int checkExrHeaders(const std::filesystem::path& path, uint64_t maxNumbers = kMaxImageFloats);

// Lets OpenEXR compress on all cores, unless the process has chosen a number of threads for it.
void useExrThreads();

}  // namespace chromeball
