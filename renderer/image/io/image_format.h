// SPDX-License-Identifier: Apache-2.0
// The format of an image file, by its first bytes: many files have a wrong name.
#pragma once

#include <cstdint>
#include <span>

namespace chromeball {

enum class ImageFormat { Exr, RadianceHdr, Pfm, Png, Jpeg, Webp, Tiff, Unknown };

inline constexpr size_t kFormatBytes = 12;  // that imageFormat() looks at, at most

ImageFormat imageFormat(std::span<const uint8_t> firstBytes);

}  // namespace chromeball
