// SPDX-License-Identifier: Apache-2.0
// What an image file cannot hold of an image.
#pragma once

#include <filesystem>

#include "base/message.h"
#include "image/image.h"

namespace chromeball {

// Warnings of what writing the colour to `path` loses, each "FILE: ...":
// - in a .png, light where nothing covers the background, such as a caustic on a shadow catcher:
//   associated colour above alpha. A .png has unassociated colour, at most 1, so it holds no more
//   than alpha. Only where alpha is below one half: the rest is clipped as any bright surface is.
// - in a .png and an .hdr, negative channels;
// - in an .hdr, channels above the largest number of RGBE, and infinite and NaN ones.
Messages lostLight(const std::filesystem::path& path, const Image& color);

}  // namespace chromeball
