// SPDX-License-Identifier: Apache-2.0
// Removes metadata from TIFF files: colour profiles, EXIF, comments. We do not use them, and
// OpenImageIO 2.4 does not parse damaged ones safely: it follows the tag table of an ICC profile
// beyond the end of the profile. libtiff applies half of the orientation (mirrored, but with sides
// unswapped) to the images that it converts to RGB (YCbCr, JPEG), so that our reader, which turns
// all alike, would turn these twice.
//
// States BitsPerSample where a file leaves it out, as files of black and white do: TIFF 6.0's
// default is 1, OpenImageIO's is 8.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace chromeball {

// Changes the first directory; others are not read. Files of other formats stay as they are.
std::vector<uint8_t> stripTiff(std::span<const uint8_t> file);

}  // namespace chromeball
