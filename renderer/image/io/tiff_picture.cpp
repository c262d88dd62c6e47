// SPDX-License-Identifier: Apache-2.0
#include "image/io/tiff.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "image/size_limits.h"

namespace chromeball {
namespace {

enum PictureTag : uint16_t {
  kNewSubfileType = 254,
  kSubfileType = 255,
  kWidth = 256,
  kHeight = 257,
  kBitsPerSample = 258,
  kCompression = 259,
  kPhotometric = 262,
  kStripOffsets = 273,
  kSamplesPerPixel = 277,
  kRowsPerStrip = 278,
  kStripLengths = 279,
  kTileWidth = 322,
  kTileLength = 323,
  kTileOffsets = 324,
  kTileLengths = 325,
  kSubDirectories = 330,
  kTileDepth = 32998,
  kDngVersion = 50706
};

// Numbers of TIFF 6.0 and its technical notes, of TIFF/EP and DNG, and libtiff's for LogLuv.
enum Photometric {
  kTransparencyMask = 4,
  kCieLab = 8,
  kIccLab,
  kItuLab,
  kColorFilterArray = 32803,
  kLogL = 32844,
  kLogLuv,
  kLinearRaw = 34892
};

// The directories in the order of the pages, each page before those below it.
std::vector<uint64_t> directoriesOf(const TiffBlock& tiff) {
  constexpr size_t kMost = 256;
  constexpr size_t kMostBelow = 1024;  // listed by a page, perhaps again and again
  std::vector<uint64_t> found;
  const auto isNew = [&](uint64_t directory) {
    return directory != 0 && found.size() < kMost && std::ranges::count(found, directory) == 0;
  };
  for (uint64_t page = tiff.firstDirectory(); isNew(page); page = tiff.nextDirectory(page)) {
    found.push_back(page);
    for (const uint64_t below : tiff.integers(page, kSubDirectories, kMostBelow))
      if (isNew(below)) found.push_back(below);
  }
  return found;
}

int photometricOf(const TiffBlock& tiff, uint64_t directory) {
  return int(std::min(tiff.find(directory, kPhotometric).value_or(0), 65535.0));
}

bool isSensorImage(const TiffBlock& tiff, uint64_t directory) {
  const int photometric = photometricOf(tiff, directory);
  return photometric == kColorFilterArray || photometric == kLinearRaw;
}

// The bits of NewSubfileType; older files have SubfileType.
struct SubfileKind {
  bool isReduced, isMask;
};

SubfileKind subfileKindOf(const TiffBlock& tiff, uint64_t directory) {
  constexpr uint32_t kReducedBit = 1, kMaskBit = 4;
  constexpr double kReduced = 2;
  const auto bits = uint32_t(std::min(tiff.find(directory, kNewSubfileType).value_or(0), 1e9));
  return {(bits & kReducedBit) != 0 || tiff.find(directory, kSubfileType) == kReduced,
          (bits & kMaskBit) != 0 || photometricOf(tiff, directory) == kTransparencyMask};
}

// Canon's CR2 does not state the kind of the sensor's image. Texels of other files may follow the
// header, but not with the directory so near.
bool isCr2(const TiffBlock& tiff, std::span<const uint8_t> file) {
  constexpr size_t kMarkAt = 8, kDirectoryAt = 16;
  return tiff.firstDirectory() == kDirectoryAt && file.size() > kDirectoryAt &&
         file[kMarkAt] == 'C' && file[kMarkAt + 1] == 'R';
}

// OpenImageIO leaves the missing part of a truncated file black.
void checkWhole(const TiffBlock& tiff, uint64_t directory, uint64_t fileBytes) {
  for (const auto& [offsetTag, bytesTag] :
       {std::pair(kStripOffsets, kStripLengths), {kTileOffsets, kTileLengths}}) {
    const std::vector<uint64_t> offsets = tiff.integers(directory, offsetTag),
                                bytes = tiff.integers(directory, bytesTag);
    for (size_t i = 0; i < std::min(offsets.size(), bytes.size()); ++i)
      if (bytes[i] > fileBytes || offsets[i] > fileBytes - bytes[i])
        throw std::runtime_error("the file ends before its image");
  }
}

// Upper bounds on the bytes of texels that a byte of the file can hold, by its compression.
double maxRatioOf(int compression, double width) {
  enum Compression {
    kNone = 1,
    kCcittRle,
    kCcittFax3,
    kCcittFax4,
    kLzw,
    kJpeg = 7,
    kAdobeDeflate,
    kPackBits = 32773,
    kDeflate = 32946
  };
  switch (compression) {
    case kNone:
      return 1;
    case kCcittRle:
    case kCcittFax3:
    case kCcittFax4:
      return std::max(width, 1.0);  // a row of white takes one bit
    case kLzw:
      return 2731;  // a code of 12 bits stands for less than 4096 bytes
    case kJpeg:
      return 3 * double(kMaxTexelsPerJpegByte);  // three channels of 8 bits
    case kAdobeDeflate:
    case kDeflate:
      return double(kMaxDeflateRatio);
    case kPackBits:
      return 64;  // 128 bytes in 2
    default:
      return double(kMaxUnknownRatio);  // LZMA and Zstandard repeat a byte almost for ever
  }
}

// The largest value of an entry; 1 if there is none.
double largestOf(const TiffBlock& tiff, uint64_t directory, uint16_t tag) {
  const std::vector<uint64_t> values = tiff.integers(directory, tag);
  return values.empty() ? 1 : double(std::ranges::max(values));
}

constexpr double kAlwaysAllowed = 64 << 20;  // bytes of texels, in a file of any length

// Refuses an image that a file of this length cannot hold, before it is decoded, and tiles that do
// not fit it. Blocks that several strips or tiles share count once.
void checkSizes(const TiffBlock& tiff, uint64_t directory, uint64_t fileBytes) {
  const auto number = [&](uint16_t tag) { return largestOf(tiff, directory, tag); };
  const double width = number(kWidth), height = number(kHeight);
  const double texel = number(kSamplesPerPixel) * number(kBitsPerSample) / 8;
  const double bytes = width * height * texel;
  const auto compression = int(std::min(number(kCompression), 65535.0));
  if (bytes > std::max(kAlwaysAllowed, double(fileBytes) * maxRatioOf(compression, width)))
    throw std::runtime_error(
        fmt::format("the file is too short for {} x {} texels", width, height));
  // A tile may be larger than a small image, and is decoded as a whole.
  const double tileWidth = number(kTileWidth), tileLength = number(kTileLength),
               tileDepth = number(kTileDepth);
  const bool isSound = tileWidth >= 1 && tileLength >= 1 && tileDepth == 1;
  if (!isSound || tileWidth * tileLength * texel > std::max(kAlwaysAllowed, bytes))
    throw std::runtime_error(
        fmt::format("its tiles of {} x {} x {} texels do not fit its image of {} x {}", tileWidth,
                    tileLength, tileDepth, width, height));
}

constexpr uint16_t kTransferFunction = 301, kWhitePoint = 318, kPrimaryChromaticities = 319;

std::vector<double> chromaticitiesIn(const TiffBlock& tiff, uint16_t tag, size_t count) {
  std::vector<double> numbers = tiff.rationals(tiff.firstDirectory(), tag);
  if (numbers.size() != count)
    throw std::runtime_error(
        "its WhitePoint or PrimaryChromaticities are not two and six rational numbers");
  return numbers;
}

}  // namespace

uint64_t pictureDirectory(std::span<const uint8_t> file) {
  const TiffBlock tiff(file);
  const std::vector<uint64_t> directories = directoriesOf(tiff);
  if (directories.empty()) return tiff.firstDirectory();  // which the library refuses
  const bool hasThumbnailOfDng =
      tiff.has(directories[0], kDngVersion) && subfileKindOf(tiff, directories[0]).isReduced;
  if (hasThumbnailOfDng || isCr2(tiff, file) ||
      std::ranges::any_of(directories, [&](uint64_t at) { return isSensorImage(tiff, at); }))
    throw std::runtime_error(
        "it is a camera's raw file (DNG, NEF, CR2, ...), whose colours are the sensor's: develop "
        "it to linear .exr or .tif first");
  const auto isPicture = [&](uint64_t at) {
    const SubfileKind kind = subfileKindOf(tiff, at);
    return !kind.isReduced && !kind.isMask;
  };
  const auto found = std::ranges::find_if(directories, isPicture);
  const uint64_t picture = found == directories.end() ? directories[0] : *found;
  if (subfileKindOf(tiff, picture).isMask)
    throw std::runtime_error("it holds a transparency mask alone");
  const int photometric = photometricOf(tiff, picture);
  if (photometric == kLogL || photometric == kLogLuv)
    throw std::runtime_error(
        "its texels are LogL or LogLuv, of which only 8 bits would be read: convert it to .exr, "
        ".hdr or a .tif of floats");
  // libtiff takes its white, D50, for sRGB's, and ICC's numbers for CIE's.
  if (photometric >= kCieLab && photometric <= kItuLab)
    throw std::runtime_error(
        "its texels are L*a*b*, of which only 8 bits would be read, tinted: convert it to RGB");
  checkWhole(tiff, picture, file.size());
  checkSizes(tiff, picture, file.size());
  return picture;
}

std::vector<uint8_t> withStripsInside(std::vector<uint8_t> file) {
  const TiffBlock tiff(file);
  const uint64_t directory = tiff.firstDirectory();
  const std::vector<uint64_t> rows = tiff.integers(directory, kRowsPerStrip),
                              height = tiff.integers(directory, kHeight);
  if (rows.size() != 1 || height.size() != 1 || rows[0] <= height[0]) return file;
  return tiff.withInteger(directory, kRowsPerStrip, height[0]);
}

std::optional<Chromaticities> tiffPrimaries(std::span<const uint8_t> file) {
  const TiffBlock tiff(file);
  const auto states = [&](uint16_t tag) { return tiff.has(tiff.firstDirectory(), tag); };
  if (!states(kWhitePoint) && !states(kPrimaryChromaticities)) return {};
  Chromaticities space;
  if (states(kWhitePoint)) {
    const std::vector<double> xy = chromaticitiesIn(tiff, kWhitePoint, 2);
    space.white = {xy[0], xy[1]};
  }
  if (states(kPrimaryChromaticities)) {
    const std::vector<double> xy = chromaticitiesIn(tiff, kPrimaryChromaticities, 6);
    space.red = {xy[0], xy[1]}, space.green = {xy[2], xy[3]}, space.blue = {xy[4], xy[5]};
  }
  return space;
}

bool statesGrey(std::span<const uint8_t> file) {
  const TiffBlock tiff(file);
  const std::vector<uint64_t> stated = tiff.integers(tiff.firstDirectory(), kPhotometric);
  constexpr uint64_t kLargestOfGrey = 1;  // 0 if 0 is white
  return !stated.empty() && stated[0] <= kLargestOfGrey;
}

bool statesAlpha(std::span<const uint8_t> file) {
  constexpr uint16_t kExtraSamples = 338;
  const TiffBlock tiff(file);
  return tiff.has(tiff.firstDirectory(), kExtraSamples);
}

bool hasTransferTable(std::span<const uint8_t> file) {
  const TiffBlock tiff(file);
  return tiff.has(tiff.firstDirectory(), kTransferFunction);
}

}  // namespace chromeball
