// SPDX-License-Identifier: Apache-2.0
// Which image of a TIFF is its picture. A file may hold several: pages, thumbnails, masks, and in
// directories below those (TIFF Technical Note 1, SubIFDs) the levels of a pyramid or the data of a
// camera's sensor.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "image/chromaticities.h"

namespace chromeball {

// The offset of the directory of the first image that is neither reduced nor a mask; of the first
// image if there is none. Throws std::runtime_error for files whose picture OpenImageIO does not
// show: camera files, which hold the numbers of a sensor and a thumbnail; masks alone; LogLuv,
// which it clips to 8 bits; truncated files, and files too short for what they claim to hold.
uint64_t pictureDirectory(std::span<const uint8_t> tiff);

// The file with RowsPerStrip no larger than its first image, where it may be any number (TIFF 6.0)
// and OpenImageIO's calculations exceed an int.
std::vector<uint8_t> withStripsInside(std::vector<uint8_t> file);

// The primaries that a TIFF's first image states (TIFF 6.0, section 20: WhitePoint and
// PrimaryChromaticities); Rec. 709's for the one that it leaves out, nullopt if it states neither.
// Throws std::runtime_error if they are not two and six rational numbers.
std::optional<Chromaticities> tiffPrimaries(std::span<const uint8_t> file);

// Whether PhotometricInterpretation says that it is grey, whatever the number of its samples.
bool statesGrey(std::span<const uint8_t> file);

// Whether it says what its samples beyond the colour are (ExtraSamples). OpenImageIO takes a fourth
// one for associated alpha also where it does not.
bool statesAlpha(std::span<const uint8_t> file);

// Whether it has a table of the light of its integers (TransferFunction), which is not applied.
bool hasTransferTable(std::span<const uint8_t> file);

}  // namespace chromeball
