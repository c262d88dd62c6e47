// SPDX-License-Identifier: Apache-2.0
// OpenEXR files with layers, attributes, and what this program reads again (exr_state.h).
#pragma once

#include <filesystem>
#include <span>

#include "image/io/write_image.h"

namespace chromeball {

// Writes float32 scanlines with ZIP compression, and output.state if it is set. Atomic. Throws
// RunError.
void writeExr(const std::filesystem::path& path, const OutputImage& output);

// Channels of one image, as many names as it has.
struct ChannelBlock {
  std::vector<std::string> names;
  const Image* image;
};

// The same for blocks of one size with any number of channels. `halves`: texels of 16 bits, in
// which numbers above 65504 become infinite.
void writeExr(const std::filesystem::path& path, std::span<const ChannelBlock> blocks,
              const Metadata& metadata, bool halves);

}  // namespace chromeball
