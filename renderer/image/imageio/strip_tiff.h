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

// Numbers of 64 bits whose samples are contiguous OpenImageIO 2.4 leaves undecoded, so that what it
// returns is whatever its memory held: they are read as bytes.

struct BytesOfDoubles {
  std::vector<uint8_t> file;  // its first image is one of bytes, eight times as wide
  bool bigEndian = false;
  int predictor = 1;  // of the doubles: none (1), horizontal (TIFF 6.0, section 14), of floats (3)
};

// Of a file that stripTiff() has returned. Throws std::runtime_error if its directory is damaged.
BytesOfDoubles bytesOfDoubles(std::span<const uint8_t> file);

// The numbers of a row of `image`, of a tile if it has tiles, with `samples` numbers for each
// texel; changes the row. Throws std::runtime_error for an unknown predictor.
void decodeDoubles(const BytesOfDoubles& image, std::span<uint8_t> row, size_t samples,
                   std::vector<double>& numbers);

}  // namespace chromeball
