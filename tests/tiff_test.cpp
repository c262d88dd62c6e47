// SPDX-License-Identifier: Apache-2.0
// The image of a TIFF that is read, its orientation, and the files that are refused.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "base/error.h"
#include "icc_file.h"
#include "image/image.h"
#include "image/io/read_image.h"
#include "image/io/tiff.h"
#include "run_command.h"
#include "tiff_file.h"

namespace chromeball::tiff_test {
namespace {

constexpr int kWidth = 6, kHeight = 4;
constexpr uint16_t kNewSubfileType = 254, kSubfileType = 255, kOrientation = 274,
                   kYCbCrSubSampling = 530, kDngVersion = 50706;
constexpr uint32_t kReduced = 1, kMaskBit = 4;

// No two texels are alike.
std::string texels(int width, int height, int samples) {
  std::string bytes;
  for (int i = 0; i < width * height; ++i)
    for (int c = 0; c < samples; ++c) bytes += char(40 + 7 * i + 5 * c);
  return bytes;
}

TiffImage rgb(const std::vector<TiffEntry>& more = {}) {
  return {kWidth, kHeight, texels(kWidth, kHeight, 3), 2, 3, 8, 1, 1, more};
}

TiffImage thumbnail(const std::vector<TiffEntry>& more = {{kNewSubfileType, 4, {kReduced}}}) {
  return {2, 1, std::string(6, '\x7f'), 2, 3, 8, 1, 1, more};
}

// A sensor image with `samples` numbers of 16 bits.
TiffImage sensor(uint16_t photometric, uint16_t samples) {
  return {kWidth,      kHeight, std::string(size_t(kWidth * kHeight * samples * 2), 'x'),
          photometric, samples, 16};
}

class Tiff : public testing::Test {
 protected:
  ImageFile read(const std::string& file) const {
    std::ofstream(path(), std::ios::binary) << file;
    return readImageFile(path());
  }
  ImageFile read(const std::vector<TiffImage>& pages) const {
    return read(TiffWriter::file(pages));
  }
  void refuse(const std::string& file, const std::string& reason) const {
    try {
      read(file);
      ADD_FAILURE() << reason;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  }
  void refuse(const std::vector<TiffImage>& pages, const std::string& reason) const {
    refuse(TiffWriter::file(pages), reason);
  }

 private:
  std::string path() const { return folder_ / "a.tif"; }
  TemporaryFolder folder_;
};

// RFC 1950, of stored blocks of one byte each.
std::string deflatedOf(const std::string& bytes) {
  std::string file = "\x78\x01";
  uint32_t a = 1, b = 0;  // Adler-32
  for (size_t i = 0; i < bytes.size(); ++i) {
    const bool isLast = i + 1 == bytes.size();
    file += std::string({char(isLast), 1, 0, char(0xfe), char(0xff), bytes[i]});
    a = (a + uint8_t(bytes[i])) % 65521;
    b = (a + b) % 65521;
  }
  for (const uint32_t byte : {b >> 8, b, a >> 8, a}) file += char(byte);
  return file;
}

// What a predictor leaves of rows of doubles (TIFF 6.0, section 14; TIFF's technical note 3).
std::string predicted(const std::vector<double>& numbers, size_t rowLength, size_t samples,
                      uint32_t predictor) {
  std::string bytes(8 * numbers.size(), 0);
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  for (size_t row = 0; row < numbers.size(); row += rowLength) {
    const std::string plain = bytes.substr(8 * row, 8 * rowLength);
    char* to = &bytes[8 * row];
    if (predictor == 2)
      for (size_t i = rowLength - 1; i >= samples; --i) {
        uint64_t one, before;
        std::memcpy(&one, &plain[8 * i], 8);
        std::memcpy(&before, &plain[8 * (i - samples)], 8);
        one -= before;
        std::memcpy(to + 8 * i, &one, 8);
      }
    if (predictor == 3) {
      for (size_t i = 0; i < plain.size(); ++i) to[(7 - i % 8) * rowLength + i / 8] = plain[i];
      for (size_t i = plain.size() - 1; i >= samples; --i) to[i] = char(to[i] - to[i - samples]);
    }
  }
  return bytes;
}

// OpenImageIO does not check them, and would write out of bounds, or not end.
TEST_F(Tiff, TilesThatDoNotFitTheirImageAreRefused) {
  constexpr uint16_t kTileWidth = 322, kTileLength = 323, kTileDepth = 32998;
  const auto tiled = [](uint32_t width, uint32_t length, uint32_t depth) {
    return std::vector<TiffImage>{
        rgb({{kTileWidth, 4, {width}}, {kTileLength, 4, {length}}, {kTileDepth, 4, {depth}}})};
  };
  for (const uint32_t large : {1u << 31, 0xffffffffu, 0u})
    for (const auto& pages : {tiled(large, 16, 1), tiled(16, large, 1), tiled(16, 16, large)})
      refuse(pages, "do not fit its image");
  refuse(tiled(65536, 16384, 1), "do not fit its image");
}

// Any number above the image's height means one strip.
TEST_F(Tiff, StripsMayHaveMoreRowsThanTheImage) {
  TiffImage image = rgb();
  image.compression = 8;
  image.texels = deflatedOf(image.texels);
  const std::vector<float> plain = read({rgb()}).image.texels;
  for (const uint32_t rows : {uint32_t(kHeight), 1u << 30, 0x7fffffefu, 0x7fffffffu, 0xffffffffu}) {
    std::string file = TiffWriter::file({image});
    const std::string entry("\x16\x01\x04\x00\x01\x00\x00\x00", 8);  // RowsPerStrip
    const size_t at = file.find(entry) + entry.size();
    for (int i = 0; i < 4; ++i) file[at + size_t(i)] = char(rows >> 8 * i & 0xff);
    EXPECT_EQ(read(file).image.texels, plain) << rows;
  }
}

TEST_F(Tiff, NumbersOf64BitsAreRead) {
  constexpr int kSide = 16;
  for (const bool isTiled : {false, true})
    for (const uint16_t samples : {uint16_t(1), uint16_t(3), uint16_t(4)})
      for (const uint32_t predictor : {1, 2, 3}) {
        std::vector<double> numbers;
        for (int i = 0; i < kSide * kSide * samples; ++i) numbers.push_back(0.3 * i - 5);
        numbers[7] = 1e10, numbers[8] = 1e-8;
        // Only compressed texels are predicted: here by Deflate, in stored blocks.
        const std::string bytes = predicted(numbers, size_t(kSide * samples), samples, predictor);
        TiffImage image{kSide, kSide, predictor == 1 ? bytes : deflatedOf(bytes), 2, samples, 64};
        image.format = 3;
        image.photometric = samples == 1 ? 1 : 2;
        image.compression = predictor == 1 ? 1 : 8;
        image.isTiled = isTiled;
        if (predictor > 1) image.more = {{317, 3, {predictor}}};
        EXPECT_EQ(read({image}).image.texels, std::vector<float>(numbers.begin(), numbers.end()))
            << isTiled << ' ' << samples << ' ' << predictor;
      }
}

// libtiff mirrors the images that it converts to RGB, so that these would be turned twice.
TEST_F(Tiff, AllKindsAreTurnedOnce) {
  const std::string jpeg = fileContents(std::string(kSourceDir) + "/tests/fuzz/seeds/image/a.jpg");
  const TemporaryFolder folder;
  std::ofstream(folder / "a.jpg", std::ios::binary) << jpeg;
  const Image whole = readImage(folder / "a.jpg");
  TiffImage plain = rgb(), luminanceChroma = rgb({{kYCbCrSubSampling, 3, {1, 1}}});
  luminanceChroma.photometric = 6;
  const TiffImage compressed{
      whole.width, whole.height, jpeg, 6, 3, 8, 7, 1, {{kYCbCrSubSampling, 3, {2, 2}}}};
  TiffImage grey{kWidth, kHeight, texels(kWidth, kHeight, 1), 1, 1};
  for (const TiffImage& image : {plain, luminanceChroma, compressed, grey}) {
    const Image stored = read({image}).image;
    for (uint32_t orientation = 1; orientation <= 8; ++orientation) {
      TiffImage turned = image;
      turned.more.push_back({kOrientation, 3, {orientation}});
      const Image seen = oriented(stored, int(orientation)), found = read({turned}).image;
      EXPECT_EQ(found.width, seen.width);
      EXPECT_EQ(found.texels, seen.texels) << image.photometric << " turned " << orientation;
    }
  }
}

TEST_F(Tiff, TheFirstFullImageIsRead) {
  const Image picture = read({rgb()}).image;
  const auto check = [&](const std::vector<TiffImage>& pages, bool isFirst) {
    const ImageFile file = read(pages);
    EXPECT_EQ(file.image.width, kWidth);
    EXPECT_EQ(file.image.texels, picture.texels);
    EXPECT_EQ(file.messages.empty(), isFirst);
  };
  const TiffImage mask{kWidth, kHeight, texels(kWidth, kHeight, 1),        4, 1, 8,
                       1,      1,       {{kNewSubfileType, 4, {kMaskBit}}}};
  TiffImage pyramid = rgb(), parent = thumbnail();
  pyramid.below = {thumbnail()};
  parent.below = {rgb()};
  check({rgb(), thumbnail()}, true);
  check({pyramid}, true);
  check({thumbnail(), rgb()}, false);
  check({thumbnail(), thumbnail(), mask, rgb(), thumbnail()}, false);
  check({thumbnail({{kSubfileType, 3, {2}}}), rgb()}, false);
  check({mask, rgb()}, false);
  check({parent}, false);
  EXPECT_EQ(read({thumbnail()}).image.width, 2) << "it is the only one";
  refuse({mask}, "a transparency mask alone");
}

// The orientation belongs to the image that is read.
TEST_F(Tiff, EachPageHasItsOrientation) {
  const TiffImage turned = rgb({{kOrientation, 3, {6}}});
  EXPECT_EQ(read({thumbnail(), turned}).image.texels, read({turned}).image.texels);
}

TEST_F(Tiff, RawFilesOfCamerasAreRefused) {
  constexpr uint16_t kColorFilterArray = 32803, kLinearRaw = 34892;
  constexpr const char* kReason = "a camera's raw file";
  TiffImage nef = thumbnail(), linear = thumbnail();
  nef.below = {sensor(kColorFilterArray, 1)};
  linear.below = {thumbnail(), sensor(kLinearRaw, 3)};
  refuse({nef}, kReason);
  refuse({linear}, kReason);
  refuse({sensor(kColorFilterArray, 1)}, kReason);
  refuse({sensor(kLinearRaw, 3)}, kReason);
  refuse({rgb(), sensor(kColorFilterArray, 1)}, kReason);
  refuse({thumbnail({{kNewSubfileType, 4, {kReduced}}, {kDngVersion, 4, {1}}})}, kReason);
  // CR2: a mark and its version after the header, then the directory.
  std::string cr2 = TiffWriter::file({rgb()}, std::string("CR\2\0\0\0\0\0", 8));
  cr2[4] = 16, cr2[5] = 0;
  refuse(cr2, kReason);
  EXPECT_EQ(read(TiffWriter::file({rgb()}, "CR\2\1xxxx")).image.width, kWidth)
      << "texels may have these bytes";
}

TEST_F(Tiff, LogLuvIsRefused) {
  TiffImage color = rgb(), grey = rgb();
  color.photometric = 32845;
  grey.photometric = 32844;
  for (TiffImage* image : {&color, &grey}) image->compression = 34676;
  refuse({color}, "LogLuv");
  refuse({grey}, "LogL");
  refuse({thumbnail(), color}, "LogLuv");
}

TEST_F(Tiff, TruncatedFilesAreRefused) {
  TiffImage luminanceChroma = rgb({{kYCbCrSubSampling, 3, {1, 1}}});
  luminanceChroma.photometric = 6;
  for (const TiffImage& image : {rgb(), luminanceChroma}) {
    const std::string file = TiffWriter::file({image});  // the texels are its end
    for (const size_t missing : {size_t(1), image.texels.size() / 2, image.texels.size()})
      refuse(file.substr(0, file.size() - missing), "the file ends before its image");
  }
}

// Files that OpenImageIO returns black or in part: strips of compressions that libtiff was built
// without (JPEG 2000, JPEG XL), and damaged ones.
TEST_F(Tiff, TexelsThatCannotBeDecodedAreRefused) {
  constexpr uint16_t kLzw = 5, kAdobeDeflate = 8, kDeflate = 32946, kJpeg2000 = 34712,
                     kJpegXl = 50002;
  for (const uint16_t compression : {kLzw, kAdobeDeflate, kDeflate, kJpeg2000, kJpegXl}) {
    TiffImage image = rgb();
    image.compression = compression;
    refuse({image}, "cannot be read: ");
    refuse({thumbnail(), image}, "cannot be read: ");
  }
}

// zlib's bound on its own output for a strip does not bound other writers' output.
TEST_F(Tiff, DeflateMayBeLongerThanItsTexels) {
  TiffImage deflated = rgb();
  deflated.compression = 8;
  deflated.texels = deflatedOf(deflated.texels);
  EXPECT_EQ(read({deflated}).image.texels, read({rgb()}).image.texels);
}

// libtiff stops before the checksum.
TEST_F(Tiff, DamagedDeflateIsRefused) {
  const std::string whole = deflatedOf(rgb().texels);
  const auto deflated = [&](const std::string& texels, uint16_t compression) {
    TiffImage image = rgb();
    image.compression = compression;
    image.texels = texels;
    return image;
  };
  constexpr size_t kChecksum = 4, kStored = 6;  // bytes, of each texel too
  for (const uint16_t compression : {8, 32946}) {
    for (const size_t fromEnd :
         {size_t(1), kChecksum, kChecksum + 1, kChecksum + 5 * kStored + 1}) {
      std::string damaged = whole;
      damaged[damaged.size() - fromEnd] ^= 4;
      refuse({deflated(damaged, compression)}, "block 1 of its texels is damaged");
      refuse({thumbnail(), deflated(damaged, compression)}, "block 1 of its texels is damaged");
    }
    // A stream that was flushed and never ended has no checksum, but is not damaged.
    std::string flushed = whole.substr(0, whole.size() - kChecksum);
    flushed[flushed.size() - kStored] = 0;  // not the last block
    for (const std::string& texels : {whole + "more", flushed})
      EXPECT_EQ(read({deflated(texels, compression)}).image.texels, read({rgb()}).image.texels);
  }
}

// Of several values the field has the offset: that of BitsPerSample is below 65536 here, so that
// the upper half of a big-endian one is 0.
TEST_F(Tiff, TheFirstOfSeveralValuesIsReadWhereTheyAre) {
  const std::string field("\0\0\0\x40", 4), pad(64 - 26, '\0');
  std::string file("MM\0*\0\0\0\x08\0\x01", 10);
  file += std::string("\x01\x02\0\x03\0\0\0\x03", 8) + field + std::string(4, '\0') + pad;
  file += std::string("\0\x10\0\x10\0\x10", 6);
  const auto* bytes = reinterpret_cast<const uint8_t*>(file.data());
  const TiffBlock block(std::span(bytes, file.size()));
  EXPECT_EQ(block.find(block.firstDirectory(), 258), 16);
}

// libtiff reverses the bits before it inflates; the module that reads these returns black.
TEST_F(Tiff, DeflateOfReversedBitsIsRefusedByName) {
  TiffImage image = rgb({{266, 3, {2}}});
  image.compression = 8;
  image.texels = deflatedOf(image.texels);
  for (char& byte : image.texels) {
    int reversed = 0;
    for (int bit = 0; bit < 8; ++bit) reversed |= (byte >> bit & 1) << (7 - bit);
    byte = char(reversed);
  }
  refuse({image}, "FillOrder 2");
}

// TIFF 6.0, section 20: rational numbers.
TEST_F(Tiff, PrimariesAreConverted) {
  constexpr uint16_t kRational = 5, kWhitePoint = 318, kPrimaries = 319;
  const auto entry = [](uint16_t tag, const std::vector<uint32_t>& numbers) {
    TiffEntry result{tag, kRational, {}};
    for (const uint32_t number : numbers)
      for (const uint32_t part : {number, 10000u}) result.values.push_back(part);
    return result;
  };
  const TiffEntry p3 = entry(kPrimaries, {6800, 3200, 2650, 6900, 1500, 600}),
                  rec709 = entry(kPrimaries, {6400, 3300, 3000, 6000, 1500, 600}),
                  d65 = entry(kWhitePoint, {3127, 3290}), d50 = entry(kWhitePoint, {3457, 3585});
  const ImageFile plain = read({rgb()}), wide = read({rgb({p3, d65})});
  EXPECT_FALSE(plain.primaries);
  const Chromaticities expected{{0.68, 0.32}, {0.265, 0.69}, {0.15, 0.06}, {0.3127, 0.329}};
  EXPECT_EQ(wide.primaries, expected);
  ASSERT_EQ(wide.messages.size(), 1u);
  EXPECT_NE(wide.messages[0].text.find("converted to Rec. 709"), std::string::npos);
  const Rgb stored = findColor(plain)->rgb(1, 1), found = findColor(wide)->rgb(1, 1);
  const Rgb converted(*toRec709(expected) * glm::dvec3(stored));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], converted[c], 1e-6f);
  EXPECT_EQ(read({rgb({p3})}).primaries, expected) << "the white that it leaves out";
  EXPECT_EQ(read({rgb({d50})}).primaries->white, glm::dvec2(0.3457, 0.3585));
  const ImageFile same = read({rgb({rec709, d65})});
  EXPECT_TRUE(same.messages.empty());
  EXPECT_EQ(findColor(same)->texels, findColor(plain)->texels);
  EXPECT_EQ(read({thumbnail(), rgb({p3})}).primaries, expected) << "those of the picture";
  refuse({rgb({entry(kPrimaries, {6800, 3200})})}, "six rational numbers");
  refuse({rgb({{kWhitePoint, 4, {1, 1}}})}, "two and six rational numbers");
  refuse({rgb({entry(kPrimaries, {0, 0, 0, 0, 0, 0})})}, "degenerate");
}

TEST_F(Tiff, ColoursThatAreNotAppliedAreNamed) {
  constexpr uint16_t kTransferFunction = 301, kProfile = 34675;
  const auto floats = [&](const IccBytes& profile) {
    const TiffEntry entry{kProfile, 7, {profile.begin(), profile.end()}};
    return read({TiffImage{1, 1, std::string(12, '\0'), 2, 3, 32, 1, 3, {entry}}}).messages;
  };
  for (const IccBytes& other :
       {IccBytes(40, 'x'), iccProfile(iccSrgbCurve()), iccProfile(iccCurve({}), kIccDisplayP3)}) {
    const Messages messages = floats(other);
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_NE(messages[0].text.find("read as linear Rec. 709"), std::string::npos);
  }
  EXPECT_TRUE(floats(iccProfile(iccCurve({}))).empty());
  const ImageFile table = read({rgb({{kTransferFunction, 3, std::vector<uint32_t>(256, 9)}})});
  ASSERT_EQ(table.messages.size(), 1u);
  EXPECT_NE(table.messages[0].text.find("TransferFunction"), std::string::npos);
}

// libtiff's conversion tints it: white of L*a*b* is (1, 1, 0.83).
TEST_F(Tiff, LabIsRefused) {
  for (const uint16_t photometric : {8, 9, 10}) {
    TiffImage image = rgb();
    image.photometric = photometric;
    refuse({image}, "L*a*b*");
  }
}

// TIFF 6.0, section 8: without BitsPerSample a sample has one bit. Scanners and PIL leave it out.
TEST_F(Tiff, ASampleHasOneBitUnlessBitsAreStated) {
  const std::string rows("\x80\x40\xa5\xff", 4);  // 8 x 4 texels
  for (const uint16_t photometric : {0, 1}) {
    const TiffImage stated{8, 4, rows, photometric, 1, 1};
    TiffImage unstated = stated;
    unstated.bits = 0;
    const std::vector<float> found = read({unstated}).image.texels;
    EXPECT_EQ(found, read({stated}).image.texels);
    EXPECT_EQ(found[0], photometric == 1 ? 1.0f : 0.0f);
    unstated.more = {{kOrientation, 3, {1}}};  // one entry more, one less
    EXPECT_EQ(read({unstated}).image.texels, found);
    EXPECT_EQ(read({thumbnail(), unstated}).image.texels, found);
  }
}

// PhotometricInterpretation 0; OpenImageIO turns the texels of 8 bits alone.
TEST_F(Tiff, ZeroIsWhiteOfAnyBits) {
  for (const uint16_t bits : {8, 16, 32}) {
    const std::string light(bits / 8, '\xc0'), dark(bits / 8, '\x3f');
    const std::vector<float> stored = read({{2, 1, light + dark, 0, 1, bits}}).image.texels,
                             plain = read({{2, 1, dark + light, 1, 1, bits}}).image.texels;
    for (size_t i = 0; i < 2; ++i) EXPECT_NEAR(stored[i], plain[i], 1e-6) << bits;
    // Alpha, which is not associated, is as it is stored.
    const std::vector<TiffEntry> unassociated = {{338, 3, {2}}};
    const std::vector<float>
        clear = read({{1, 1, light + dark, 0, 2, bits, 1, 1, unassociated}}).image.texels,
        same = read({{1, 1, dark + dark, 1, 2, bits, 1, 1, unassociated}}).image.texels;
    for (size_t i = 0; i < 2; ++i) EXPECT_NEAR(clear[i], same[i], 1e-6) << bits;
  }
}

// TIFF 6.0, section 18: associated alpha has multiplied the codes, here of 200 and 255.
TEST_F(Tiff, AssociatedCodesAreDecodedWithoutTheirAlpha) {
  const auto of = [&](const std::string& codes, uint32_t kind) {
    return read({{2, 1, codes, 1, 2, 8, 1, 1, {{338, 3, {kind}}}}}).image.texels;
  };
  const std::vector<float> straight = of("\xc8\x80\xff\x33", 2),
                           associated = of("\x64\x80\x33\x33", 1);
  ASSERT_EQ(associated.size(), 4u);
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(associated[i], straight[i], 0.004) << i;
  EXPECT_NEAR(associated[2], 0.2f, 1e-6) << "white, a fifth covered";
  EXPECT_EQ(of(std::string("\x00\x00\x00\x00", 4), 1), std::vector<float>(4, 0.0f));
}

// Codes above their alpha are not multiplied by it; neither are those beside a fourth sample that
// the file does not explain.
TEST_F(Tiff, CodesThatExceedAlphaAreNoBrighterThanWhite) {
  std::string codes;
  for (const int alpha : {0, 1, 3, 100, 199, 200, 230, 255})
    codes += "\xc8\xc8\xc8" + std::string(1, char(alpha));
  const float stored = read({{1, 1, "\xc8\xc8\xc8"}}).image.texels[0];
  const ImageFile unstated = read({{8, 1, codes, 2, 4}}),
                  associated = read({{8, 1, codes, 2, 4, 8, 1, 1, {{338, 3, {1}}}}});
  for (int x = 0; x < 8; ++x) {
    EXPECT_NEAR(findColor(unstated)->rgb(x, 0).x, stored, 1e-6) << x;
    const float color = associated.image.at(x, 0)[0], alpha = associated.image.at(x, 0)[3];
    if (x < 6) {  // the codes are not below alpha: covered whole
      EXPECT_NEAR(color, std::max(stored, alpha), 1e-6) << x;
    }
    EXPECT_GE(color, stored - 1e-6) << x;
    EXPECT_LE(color, 1) << x;
  }
}

// Further samples of unstated meaning, which OpenImageIO calls green, blue or alpha.
TEST_F(Tiff, GreyStaysGreyBesideOtherSamples) {
  constexpr uint16_t kExtraSamples = 338;
  using Names = std::vector<std::string>;
  const auto grey = [&](uint16_t samples, const std::vector<uint32_t>& extra) {
    return read({{2, 1, texels(2, 1, samples), 1, samples, 8, 1, 1, {{kExtraSamples, 3, extra}}}});
  };
  const ImageFile two = grey(2, {0}), four = grey(4, {0, 1, 0}), three = grey(3, {0, 0});
  EXPECT_EQ(two.channels, (Names{"Y", "channel1"}));
  EXPECT_EQ(four.channels, (Names{"Y", "channel1", "A", "channel3"}));
  for (const ImageFile* file : {&two, &four})
    EXPECT_EQ(findColor(*file)->rgb(1, 0), Rgb(file->image.at(1, 0)[0]));
  EXPECT_EQ(three.channels, (Names{"R", "G", "B"}));
  ASSERT_EQ(three.messages.size(), 1u);
  EXPECT_NE(three.messages[0].text.find("says that it is grey"), std::string::npos);
  EXPECT_TRUE(two.messages.empty() && four.messages.empty());
}

// No file of 5 kB holds 400 MB, however it is compressed; nothing is decoded to find this out.
TEST_F(Tiff, FilesTooShortForTheirTexelsAreRefused) {
  constexpr uint16_t kNone = 1, kLzw = 5, kJpeg = 7, kAdobeDeflate = 8, kPackBits = 32773,
                     kDeflate = 32946;
  TiffImage image{16384, 8192, std::string(5000, '\0')};
  for (const uint16_t compression : {kNone, kLzw, kJpeg, kAdobeDeflate, kPackBits, kDeflate}) {
    image.compression = compression;
    refuse({image}, "a.tif: cannot be read: the file is too short for 16384 x 8192 texels");
    refuse({thumbnail(), image}, "too short for 16384 x 8192 texels");
  }
  // Black and white; a row takes at least a bit: 2^17 rows of 2^15 bits do not fit into 5 kB.
  constexpr uint16_t kCcittFax4 = 4;
  refuse({{1 << 15, 1 << 17, std::string(5000, '\0'), 0, 1, 1, kCcittFax4}}, "too short for");
}

// Directories that point to each other, and truncated ones.
TEST_F(Tiff, DamagedDirectoriesAreHarmless) {
  TiffImage parent = thumbnail();
  parent.below = {rgb()};
  const std::string file = TiffWriter::file({parent, thumbnail(), rgb()});
  for (size_t length = 8; length < file.size(); length += 3) try {
      read(file.substr(0, length));
    } catch (const InputError&) {
    }
  for (size_t at = 4; at < file.size(); at += 5)
    for (const char byte : {'\0', '\x8', '\x7f', '\xff'}) {
      std::string damaged = file;
      damaged[at] = byte;
      try {
        read(damaged);
      } catch (const InputError&) {
      }
    }
}

}  // namespace
}  // namespace chromeball::tiff_test
