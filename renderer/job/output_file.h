// SPDX-License-Identifier: Apache-2.0
// Where results go, checked before the work that makes them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace chromeball {

// Throws InputError unless `path` ends in one of `extensions` (".svg"); and as checkReplaceable
// (base/file.h) does.
void checkOutputFile(const std::string& path, const std::vector<std::string_view>& extensions);

// Throws InputError where an output is the same file as an input or as another output, by whatever
// names and links. Empty names stand for files that were not asked for.
void checkDistinct(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

// An image that a scene file names: as checkWritable (image/write.h), but the folder it lies in may
// be missing from one that exists. makeFolder() then makes it, once nothing can be wrong any more.
void checkSceneOutput(const std::string& path);
void makeFolder(const std::string& path);  // throws RunError

// Writes text atomically. Throws RunError.
void writeText(const std::string& path, std::string_view text);

}  // namespace chromeball
