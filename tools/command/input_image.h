// SPDX-License-Identifier: Apache-2.0
// Reads the images of a command, and prints their readers' messages: channels chosen, fields of the
// header applied, colours converted.
#pragma once

#include <string>
#include <string_view>

#include "image/io/read_image.h"
#include "probe/load.h"

namespace chromeball {

// The same as readImageFile(), readImage() and loadProbe().
ImageFile openImageFile(const std::filesystem::path& path,
                        IntegerTexels integers = IntegerTexels::Srgb);
Image openImage(const std::filesystem::path& path, IntegerTexels integers = IntegerTexels::Srgb);
// The file's attributes for the image `out` that is made of it: without `envmap`, which says how a
// map is turned and which no image of ours has. Warns if that turns the map in `out`.
Metadata keptMetadata(const ImageFile& file, const std::string& in, const std::string& out);

LoadedProbe openProbe(const std::string& path, std::string_view mapping, std::string_view option);

}  // namespace chromeball
