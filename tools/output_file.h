// Where results go, checked before the work that makes them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace chromeball {

// Throws InputError unless `path` ends in one of `extensions` (".svg"); and as checkReplaceable
// (image/file.h) does.
void checkOutputFile(const std::string& path, const std::vector<std::string_view>& extensions);

// Writes text atomically. Throws RunError.
void writeText(const std::string& path, std::string_view text);

}  // namespace chromeball
