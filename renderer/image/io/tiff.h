// SPDX-License-Identifier: Apache-2.0
// TIFF 6.0 and BigTIFF: directories of tagged entries, the format of EXIF blocks too, and what they
// say of the picture.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "image/chromaticities.h"

namespace chromeball {

// The contents of the directories, not of the image. Bytes beyond the end read as 0. Offsets are
// from the begin of the block.
class TiffBlock {
 public:
  explicit TiffBlock(std::span<const uint8_t> bytes)
      : bytes_(bytes), bigEndian_(!bytes.empty() && bytes[0] == 'M'), isBig_(number(2, 2) == 43) {}

  bool isTiff() const { return isBig_ || number(2, 2) == 42; }
  uint64_t firstDirectory() const { return number(firstDirectoryAt(), offsetBytes()); }
  uint64_t nextDirectory(uint64_t directory) const;  // 0: none

  bool has(uint64_t directory, uint16_t tag) const { return entryOf(directory, tag).has_value(); }

  // The first value of the entry with this tag, if it is above 0 and finite.
  std::optional<double> find(uint64_t directory, uint16_t tag) const;

  // All values of an entry of rational numbers; empty if there is none. 0 / 0 gives NaN.
  std::vector<double> rationals(uint64_t directory, uint16_t tag) const;

  // The values of an entry of unsigned integers, such as offsets, or the first `limit` of them;
  // empty if there is none.
  std::vector<uint64_t> integers(uint64_t directory, uint16_t tag,
                                 uint64_t limit = std::numeric_limits<uint64_t>::max()) const;

  // The value of an entry of bytes; empty if there is none.
  std::span<const uint8_t> bytes(uint64_t directory, uint16_t tag) const;

  // The bytes of the block with another first value of an entry of integers, which exists.
  std::vector<uint8_t> withInteger(uint64_t directory, uint16_t tag, uint64_t value) const;

  // The bytes of the block with another directory as the first.
  std::vector<uint8_t> withFirstDirectory(uint64_t directory) const;

 private:
  uint64_t firstDirectoryAt() const { return isBig_ ? 8 : 4; }
  uint64_t offsetBytes() const { return isBig_ ? 8 : 4; }
  uint64_t countBytes() const { return isBig_ ? 8 : 2; }
  uint64_t entryBytes() const { return isBig_ ? 20 : 12; }
  uint64_t number(uint64_t at, uint64_t count) const;
  uint64_t entriesOf(uint64_t directory) const;
  std::vector<uint8_t> changed(uint64_t at, uint64_t count, uint64_t value) const;
  std::optional<uint64_t> entryOf(uint64_t directory, uint16_t tag) const;
  struct Values {
    uint64_t count, most, at;  // as stated; no more than the file can have; the place of the first
  };
  Values valuesOf(uint64_t entry, uint64_t bytesOfEach) const;

  std::span<const uint8_t> bytes_;
  bool bigEndian_, isBig_;
};

// The checksums of a TIFF's strips and tiles that are compressed by Deflate. libtiff stops at the
// last texel, before the checksum, and has no function to continue.

// Inflates the blocks of the first image (RFC 1950). Throws std::runtime_error if one is damaged. A
// block without its end, such as a flushed stream, has no checksum; texels that it lacks are the
// decoder's to find. Takes time in proportion to the file and its image: hostile blocks, which
// overlap or inflate to more, are left unverified beyond that.
void checkDeflate(std::span<const uint8_t> tiff);

// Which image of a TIFF is its picture. A file may hold several: pages, thumbnails, masks, and in
// directories below those (TIFF Technical Note 1, SubIFDs) the levels of a pyramid or the data of a
// camera's sensor.

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
