// SPDX-License-Identifier: Apache-2.0
// TIFF 6.0 and BigTIFF, the format of EXIF blocks too: directories of tagged entries.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

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

}  // namespace chromeball
