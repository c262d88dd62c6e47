// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace chromeball {

// The width of a pixel over its height, as the file's resolutions state it: those of a TIFF's first
// image (TIFF 6.0, XResolution), of a JPEG's JFIF header and of a PNG's pHYs. 1 if the file states
// none, or if they differ by less than a percent, as rounding makes them. Of the image as it is to
// be seen (EXIF orientation).
double pixelAspectRatio(std::span<const uint8_t> file);

}  // namespace chromeball
