// SPDX-License-Identifier: Apache-2.0
// Packets of the protocol for sending images to tev, the image viewer (github.com/Tom94/tev,
// include/tev/Ipc.h): the length in bytes with its own four, the type, then the fields, all
// little-endian without padding; strings end in a zero byte.
#pragma once

#include <string>
#include <vector>

#include "image/io/write_image.h"

namespace chromeball {

using TevPacket = std::vector<char>;

// The names of the channels of all layers, in the order of the files that writeImage() writes: R,
// G, B, albedo.R, ...
std::vector<std::string> channelNames(const OutputImage& image);

// CloseImage (type 2).
TevPacket closePacket(const std::string& name);
// CreateImage (type 4): an image of these channels, still black.
TevPacket createPacket(const std::string& name, const OutputImage& image);
// UpdateImageV3 (type 6): rows [top, top + rows), with the channels interleaved.
TevPacket updatePacket(const std::string& name, const OutputImage& image, int top, int rows);

}  // namespace chromeball
