// SPDX-License-Identifier: Apache-2.0
// OpenEXR files with layers, attributes, and a second part of bytes for this program.
#pragma once

#include <filesystem>
#include <functional>

#include "base/archive.h"
#include "image/io/write_image.h"

namespace chromeball {

// Writes float32 scanlines with ZIP compression. If output.state is set, the file has a second
// part, `state`, of 32-bit words: the bytes of the archive and their checksum. Atomic. Throws
// RunError.
void writeExr(const std::filesystem::path& path, const OutputImage& output);

// Reads the second part of such a file. Throws InputError if there is none, or if it is damaged.
// The checksum is of the whole part, and not compared if Checked::No.
enum class Checked { Yes, No };
void readExrState(const std::filesystem::path& path, const std::function<void(Archive&)>& read,
                  Checked checked = Checked::Yes);

}  // namespace chromeball
