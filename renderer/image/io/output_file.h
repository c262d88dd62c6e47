// SPDX-License-Identifier: Apache-2.0
// Output files, and checks to be made before rendering.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace chromeball {

// Throws InputError unless `path` ends in one of `extensions` (".svg"); and as checkReplaceable
// (base/file.h) does.
void checkOutputFile(const std::string& path, const std::vector<std::string_view>& extensions);

// Throws InputError if an output is the same file as an input, as a face of a cube map in a folder
// that is an input, or as another output, also through links. Empty names are ignored.
void checkDistinct(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

// Checks an image that a scene file names, as checkWritable (image/io/write_image.h) does, but the
// image's folder may be missing if its parent exists. makeFolder() then creates it, after all other
// checks.
void checkSceneOutput(const std::string& path);
void makeFolder(const std::string& path);  // throws RunError

// Writes text atomically. Throws RunError.
void writeText(const std::string& path, std::string_view text);

}  // namespace chromeball
