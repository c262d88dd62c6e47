// SPDX-License-Identifier: Apache-2.0
// Statements about light, colour and orientation in the headers of .hdr, PNG, JPEG and TIFF files.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "exif_block.h"
#include "image/image.h"
#include "image/io/exif.h"
#include "image/io/radiance_hdr.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "image/tonemap.h"
#include "instrumented.h"
#include "probe/capture/merge_photographs.h"
#include "probe/load.h"
#include "run_command.h"
#include "tiff_file.h"

namespace chromeball::image_headers_test {
namespace {

std::string saved(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

std::string seed(const std::string& name) {
  return fileContents(std::string(kSourceDir) + "/tests/fuzz/seeds/image/" + name);
}

// One texel, (1, .5, .25), after these lines.
std::string hdr(const std::string& lines) {
  return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n" + lines + "\n-Y 1 +X 1\n" + "\x80\x40\x20\x81";
}

TEST(ImageHeaders, RadianceLinesAreAppliedOrNamed) {
  const TemporaryFolder folder;
  const auto check = [&](const std::string& lines, const Rgb& color, const char* message) {
    const ImageFile file = readImageFile(saved(folder / "a.hdr", hdr(lines)));
    const Rgb read = findColor(file)->rgb(0, 0);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(read[c], color[c], 1e-4f) << lines;
    EXPECT_EQ(file.messages.empty(), !message) << lines;
    if (message && !file.messages.empty()) {
      EXPECT_NE(file.messages[0].text.find(message), std::string::npos) << file.messages[0].text;
    }
  };
  const Rgb plain(1, 0.5f, 0.25f);
  check("", plain, nullptr);
  check("EXPOSURE=2\nEXPOSURE=2\n", plain / 4.f, "EXPOSURE=4");
  check("EXPOSURE=1.0\n", plain, nullptr);
  check("COLORCORR=1 .5 .25\n", Rgb(1), "COLORCORR=1 0.5 0.25");
  check("COLORCORR=2 2 2\nCOLORCORR= .5 .5 .5\n", plain, nullptr);
  // Lines of real files: Photoshop's, and a doubled first line.
  check("PRIMARIES=0 0 0 0 0 0 0 0\nGAMMA=1\n#?RADIANCE\n# comment = 1\n", plain, nullptr);
  check("PRIMARIES=0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329\n", plain, nullptr);
  check("GAMMA=2.2\n", plain, "GAMMA");
  check("PIXASPECT=1\n", plain, nullptr);
  check("PIXASPECT=2\n", plain, "PIXASPECT");
  check("VIEW= -vtv -vp 0 0 0\n", plain, "VIEW");
  check("PRIMARIES=1 2 3\n", plain, "PRIMARIES");
  // AP0 is wider than Rec. 709, so its colours are more saturated.
  const ImageFile wide = readImageFile(
      saved(folder / "a.hdr", hdr("PRIMARIES=0.7347 0.2653 0 1 0.0001 -0.077 0.32168 0.33767\n")));
  EXPECT_GT(findColor(wide)->rgb(0, 0).x, 1.5f);
  for (const char* lines : {"PRIMARIES=1 1 1 1 1 1 1 1\n", "COLORCORR=0 1 1\n", "COLORCORR=2\n"})
    EXPECT_THROW(readImage(saved(folder / "a.hdr", hdr(lines))), InputError) << lines;
}

TEST(ImageHeaders, RepeatedLinesAreSaidOnce) {
  const TemporaryFolder folder;
  std::string lines;
  for (int i = 0; i < 5000; ++i) lines += "VIEW= -vtv\nGAMMA=2\n";
  const ImageFile file = readImageFile(saved(folder / "a.hdr", hdr(lines + "PIXASPECT=2\n")));
  ASSERT_EQ(file.messages.size(), 3u);
  for (const Message& message : file.messages)
    EXPECT_EQ(message.text.ends_with("(5000 lines)"),
              message.text.find("PIXASPECT") == std::string::npos)
        << message.text;
}

// Sides beyond 32 and 64 bits. Their names would be names of attributes of the .exr: reserved, of
// another type, or none.
TEST(ImageHeaders, CommentsOfAnHdrAreNoAttributes) {
  const TemporaryFolder folder;
  const std::string path =
      saved(folder / "a.hdr", hdr("# channels=x\n# compression=x\n# pixelAspectRatio=2\n# =x\n"
                                  "# envmap=latlong\n# chromaticities=x\n# mapping=angular\n"));
  EXPECT_EQ(readImageFile(path).metadata, (Metadata{{kMappingAttribute, "angular"}}));
  const CommandResult result = runCommand({"image", "develop", path, folder / "a.exr"});
  EXPECT_EQ(result.status, 0) << result.error;
  const Metadata written = readExrMetadata(folder / "a.exr");
  EXPECT_EQ(std::get<float>(written.at("pixelAspectRatio")), 1);
  for (const char* name : {kEnvmapAttribute, "chromaticities"})
    EXPECT_FALSE(written.contains(name));
}

TEST(ImageHeaders, SidesOfAnHdrDoNotWrap) {
  const TemporaryFolder folder;
  for (const char* side : {"4294967297", "18446744073709551617", "99999999999999999999999999"}) {
    const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n", texel = "\x80\x40\x20\x81";
    for (const std::string& sides :
         {std::string("-Y 1 +X ") + side, std::string("-Y ") + side + " +X 1"})
      EXPECT_THROW(readImage(saved(folder / "a.hdr", head + sides + "\n" + texel)), InputError)
          << sides;
  }
}

// A PNG of one texel with these chunks.
std::string png(const std::array<uint8_t, 3>& texel, const std::string& chunks) {
  const std::vector<uint8_t> bytes = encodePng(1, 1, 3, texel);
  std::string file(bytes.begin(), bytes.end()), kept = file.substr(0, 8);
  for (size_t at = 8; at < file.size();) {
    const auto* head = reinterpret_cast<const uint8_t*>(&file[at]);
    const size_t length = size_t(head[0]) << 24 | size_t(head[1]) << 16 | head[2] << 8 | head[3];
    const std::string type = file.substr(at + 4, 4);
    if (type == "IHDR" || type == "IDAT" || type == "IEND")
      kept += file.substr(at, length + 12) + (type == "IHDR" ? chunks : "");
    at += length + 12;
  }
  return kept;
}

std::string chunk(const std::string& type, const std::vector<uint32_t>& numbers) {
  std::string data;
  for (const uint32_t number : numbers) data += bigEndian(number, 4);
  return bigEndian(data.size(), 4) + type + data + "\1\2\3\4";
}

TEST(ImageHeaders, GammaAndPrimariesOfAPng) {
  const TemporaryFolder folder;
  const std::array<uint8_t, 3> texel = {200, 100, 50};
  const auto read = [&](const std::string& chunks, IntegerTexels integers = IntegerTexels::Srgb) {
    return readImage(saved(folder / "a.png", png(texel, chunks)), integers).rgb(0, 0);
  };
  Rgb srgb, fraction;
  for (int c = 0; c < 3; ++c) fraction[c] = float(texel[size_t(c)]) / 255;
  for (int c = 0; c < 3; ++c) srgb[c] = srgbToLinear(fraction[c]);
  const auto expectNear = [](const Rgb& a, const Rgb& b) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-6f);
  };
  expectNear(read(""), srgb);
  expectNear(read(chunk("gAMA", {45455})), srgb);  // as writers of sRGB state
  expectNear(read(chunk("gAMA", {100000})), fraction);
  expectNear(read(chunk("gAMA", {50000})), fraction * fraction);
  expectNear(read(chunk("gAMA", {0})), srgb);
  const std::string sRgb = bigEndian(1, 4) + "sRGB" + std::string(1, '\0') + "\1\2\3\4";
  expectNear(read(sRgb + chunk("gAMA", {100000})), srgb);
  expectNear(read(chunk("gAMA", {100000}), IntegerTexels::Linear), fraction);
  // Display P3: a grey stays, a colour becomes more saturated.
  const std::string p3 = chunk("cHRM", {31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000});
  const Rgb converted = read(p3);
  EXPECT_GT(converted.x, srgb.x * 1.05f);
  EXPECT_LT(converted.y, srgb.y);
  expectNear(read(p3, IntegerTexels::Linear), fraction);  // raw levels are not light
  // The cHRM of a file of light: GIMP and others write sRGB's.
  expectNear(read(chunk("cHRM", {31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000})), srgb);
}

// Code points of ITU-T H.273: primaries, transfer, matrix, full range.
std::string codePoints(uint8_t primaries, uint8_t transfer, uint8_t matrix = 0, uint8_t full = 1) {
  return chunk("cICP", {uint32_t(primaries) << 24 | uint32_t(transfer) << 16 |
                        uint32_t(matrix) << 8 | full});
}

TEST(ImageHeaders, CodePointsOfAPng) {
  const TemporaryFolder folder;
  const std::array<uint8_t, 3> texel = {200, 100, 10};
  const auto file = [&](const std::string& chunks) {
    return saved(folder / "a.png", png(texel, chunks));
  };
  const auto expectTexel = [&](const std::string& chunks, const Rgb& expected) {
    const Rgb read = readImage(file(chunks)).rgb(0, 0);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(read[c], expected[c], 2e-6f);
  };
  Rgb srgb, fraction, rec709;
  for (int c = 0; c < 3; ++c) {
    const float v = fraction[c] = float(texel[size_t(c)]) / 255;
    srgb[c] = srgbToLinear(v);
    rec709[c] = v < 0.0812429f ? v / 4.5f : std::pow((v + 0.0992968f) / 1.0992968f, 1 / 0.45f);
  }
  expectTexel(codePoints(1, 13), srgb);
  expectTexel(codePoints(2, 2), srgb);
  expectTexel(codePoints(1, 8), fraction);
  for (const uint8_t transfer : {1, 6, 14, 15}) expectTexel(codePoints(1, transfer), rec709);
  expectTexel(codePoints(1, 13) + chunk("gAMA", {100000}), srgb);  // which it overrides
  const std::string displayP3 =
      chunk("cHRM", {31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000});
  expectTexel(codePoints(12, 13), readImage(file(displayP3)).rgb(0, 0));
  Image wide(1, 1, 3);
  wide.setRgb(0, 0, fraction);
  convertColor(wide, *toRec709({{0.708, 0.292}, {0.17, 0.797}, {0.131, 0.046}, {0.3127, 0.329}}));
  expectTexel(codePoints(9, 8), wide.rgb(0, 0));
  for (const auto& [chunks, reason] :
       {std::pair{codePoints(9, 16), "the transfer PQ"},
        {codePoints(9, 18), "the transfer HLG"},
        {codePoints(9, 99), "a transfer that is not known, 99"},
        {codePoints(77, 13), "primaries that are not known here, 77"},
        {codePoints(1, 13, 9), "not RGB"},
        {codePoints(1, 13, 0, 0), "of the full range"}}) {
    try {
      readImage(file(chunks));
      ADD_FAILURE() << reason;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
    EXPECT_NO_THROW(readImage(file(chunks), IntegerTexels::Linear));  // raw levels are no light
  }
}

// Photographs of 1 texel and two exposures, merged: the channels have the encoding and primaries
// that the file states, and encodings that are not decoded elsewhere are refused.
TEST(ImageHeaders, PhotographsAreOfWhatTheirPngStates) {
  const TemporaryFolder folder;
  const std::array<uint8_t, 3> texel = {200, 100, 50};
  const auto merged = [&](const std::string& first, const std::string& second,
                          const std::string& response) {
    PhotographSeries series;
    series.files = {saved(folder / "a.png", png(texel, first)),
                    saved(folder / "b.png", png(texel, second))};
    series.times = {1, 0.5};
    series.response = response;
    series.checkAlignment = false;
    return mergePhotographs(series);
  };
  const auto expectAs = [&](const std::string& chunks, const char* response) {
    const MergedPhotographs found = merged(chunks, chunks, "");
    EXPECT_EQ(found.responseName, response);
    // For two equal pictures each channel has one factor.
    const Rgb plain = merged("", "", response).image.radiance.rgb(0, 0);
    const Rgb decoded = readImage(saved(folder / "c.png", png(texel, chunks))).rgb(0, 0);
    const Rgb undone = readImage(saved(folder / "c.png", png(texel, ""))).rgb(0, 0);
    const float factor =
        response == std::string("srgb") ? plain.y / undone.y : plain.y / (float(texel[1]) / 255);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(found.image.radiance.rgb(0, 0)[c], factor * decoded[c], 1e-5f) << chunks;
  };
  expectAs("", "srgb");
  expectAs(chunk("gAMA", {45455}), "srgb");
  expectAs(chunk("gAMA", {100000}), "linear");
  expectAs(chunk("cHRM", {31270, 32900, 70800, 29200, 17000, 79700, 13100, 4600}), "srgb");
  expectAs(codePoints(12, 13), "srgb");
  expectAs(codePoints(9, 8), "linear");
  const auto problem = [&](const std::string& first, const std::string& second,
                           const std::string& response) -> std::string {
    try {
      merged(first, second, response);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const std::string half = chunk("gAMA", {50000}), p3 = codePoints(12, 13);
  EXPECT_NE(problem(half, half, "").find("give the response"), std::string::npos);
  EXPECT_EQ(problem(half, half, "srgb"), "");
  EXPECT_NE(problem(half, "", "").find("b.png: the encoding"), std::string::npos);
  EXPECT_NE(problem(p3, codePoints(9, 13), "").find("b.png: its primaries"), std::string::npos);
  EXPECT_NE(problem(codePoints(12, 16), codePoints(12, 16), "srgb").find("PQ"), std::string::npos);
}

// A filter of 1/2, 1/4 and 1/5 is in front of the photographs' channels, not of Rec. 709's: in
// files of exposures merged, and in photographs themselves.
TEST(ImageHeaders, FiltersAreCalibratedInTheChannelsOfThePhotographs) {
  const TemporaryFolder folder;
  const std::string p3 = chunk("gAMA", {100000}) +
                         chunk("cHRM", {31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000});
  const auto file = [&](const std::string& name, const std::array<uint8_t, 3>& texel) {
    return saved(folder / name, png(texel, p3));
  };
  const auto merged = [&](const std::string& name, const std::array<uint8_t, 3>& half,
                          const std::array<uint8_t, 3>& full) {
    const CommandResult result =
        runCommand({"probe", "merge", file("half.png", half), file("full.png", full), "--exposures",
                    "1,2", "--unaligned", "-o", folder / name});
    EXPECT_EQ(result.status, 0) << result.error;
    return folder / name;
  };
  const auto transmission = [&](const std::string& with, const std::string& without) {
    return runCommand({"probe", "merge", "--calibrate-filter", with, without}).out;
  };
  const std::string expected = "transmission    0.5,0.25,0.2 of 1 pixels\n";
  const std::string without = merged("without.exr", {100, 80, 60}, {200, 160, 120});
  EXPECT_EQ(transmission(merged("with.exr", {50, 20, 12}, {100, 40, 24}), without), expected);
  EXPECT_EQ(transmission(file("a.png", {50, 20, 12}), file("b.png", {100, 80, 60})), expected);
  const std::string other = saved(folder / "c.png", png({100, 80, 60}, chunk("gAMA", {100000})));
  const CommandResult mixed = runCommand({"probe", "merge", "--calibrate-filter", without, other});
  EXPECT_EQ(mixed.status, 2);
  EXPECT_NE(mixed.error.find("primaries are not those of"), std::string::npos) << mixed.error;
}

// What covers a pixel of a photograph is no light that its sensor met.
TEST(ImageHeaders, LevelsOfPhotographsAreNotMultipliedByAlpha) {
  const TemporaryFolder folder;
  const std::vector<uint8_t> bytes = encodePng(1, 1, 4, std::vector<uint8_t>{200, 100, 50, 128});
  const std::string path = saved(folder / "a.png", std::string(bytes.begin(), bytes.end()));
  const ImageFile levels = readImageFile(path, IntegerTexels::Levels);
  constexpr std::array<uint8_t, 4> kStored = {200, 100, 50, 128};
  for (size_t c = 0; c < 4; ++c) EXPECT_FLOAT_EQ(levels.image.texels[c], float(kStored[c]) / 255);
  EXPECT_FLOAT_EQ(readImageFile(path).image.texels[0], srgbToLinear(200 / 255.f) * 128 / 255);
}

// The texel in the upper left of the picture, by where the orientation says that it is stored.
TEST(ImageHeaders, OrientationTurnsAsExifSays) {
  Image stored(3, 2, 1);
  for (int i = 0; i < 6; ++i) stored.texels[size_t(i)] = float(i);
  const std::vector<std::vector<float>> seen = {
      {0, 1, 2, 3, 4, 5}, {2, 1, 0, 5, 4, 3}, {5, 4, 3, 2, 1, 0}, {3, 4, 5, 0, 1, 2},
      {0, 3, 1, 4, 2, 5}, {3, 0, 4, 1, 5, 2}, {5, 2, 4, 1, 3, 0}, {2, 5, 1, 4, 0, 3}};
  for (int orientation = 1; orientation <= 8; ++orientation) {
    const Image image = oriented(stored, orientation);
    EXPECT_EQ(image.width, orientation < 5 ? 3 : 2);
    EXPECT_EQ(image.texels, seen[size_t(orientation - 1)]) << orientation;
  }
  for (const int other : {0, 9, -1}) EXPECT_EQ(oriented(stored, other).texels, stored.texels);
}

TEST(ImageHeaders, AllReadersTurnAlike) {
  const TemporaryFolder folder;
  for (int orientation = 1; orientation <= 8; ++orientation) {
    for (const char* name : {"a.jpg", "a.png"}) {
      const Image stored = readImage(saved(folder / name, seed(name)));
      const std::string turned = withExif(seed(name), orientationBlock(orientation));
      EXPECT_EQ(readImage(saved(folder / name, turned)).texels,
                oriented(stored, orientation).texels)
          << name << orientation;
    }
    // Some PNG files have the block with its JPEG name.
    const std::string named = std::string("Exif\0\0", 6) + orientationBlock(orientation);
    EXPECT_EQ(readImage(saved(folder / "b.png", withExif(seed("a.png"), named))).texels,
              oriented(readImage(saved(folder / "b.png", seed("a.png"))), orientation).texels);
  }
}

// Width / height equals the vertical / the horizontal resolution.
TEST(ImageHeaders, PixelsThatAreNotSquareAreSaid) {
  const TemporaryFolder folder;
  const auto said = [&](const std::string& file) {
    std::string text;
    for (const Message& message : readImageFile(saved(folder / "a", file)).messages) {
      EXPECT_EQ(message.kind, Message::Kind::Warning);
      text += message.text;
    }
    return text;
  };
  const std::string name = "pixels are not square, ", twice = name + "2 times",
                    half = name + "0.5 times";
  const auto expectSaid = [&](const std::string& file, const std::string& part) {
    if (part.empty())
      EXPECT_EQ(said(file), "");
    else
      EXPECT_NE(said(file).find(part), std::string::npos) << said(file);
  };
  constexpr size_t kDensityAt = 14;  // of the seed, in its JFIF header
  const std::string jpeg = seed("a.jpg");
  for (const auto& [x, y, part] : {std::tuple(100u, 200u, twice),
                                   {200u, 100u, half},
                                   {300u, 300u, ""},
                                   {11811u, 11812u, ""},
                                   {0u, 5u, ""},
                                   {5u, 0u, ""}}) {
    const std::array<uint8_t, 3> texel = {200, 100, 50};
    expectSaid(png(texel, chunk("pHYs", {x, y})), part);
    expectSaid(std::string(jpeg).replace(kDensityAt, 4, bigEndian(x, 2) + bigEndian(y, 2)), part);
    expectSaid(
        TiffWriter::file({{1, 1, "abc", 2, 3, 8, 1, 1, {{282, 5, {x, 1}}, {283, 5, {y, 1}}}}}),
        part);
  }
  // The picture lies on its side.
  expectSaid(
      TiffWriter::file(
          {{1, 1, "abc", 2, 3, 8, 1, 1, {{274, 3, {6}}, {282, 5, {2, 1}}, {283, 5, {1, 1}}}}}),
      twice);
}

// A TIFF or BigTIFF of directories alone: the first has a pointer of this type to the second, which
// has an exposure time of 1/40 s.
std::string directories(int pointerType, bool isBig, int orientation) {
  std::string file = isBig ? std::string("II+\0\10\0\0\0", 8) : std::string("II*\0", 4);
  const auto put = [&](uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) file += char(value >> 8 * i & 0xff);
  };
  const int offset = isBig ? 8 : 4, count = isBig ? 8 : 2;
  const auto entry = [&](int tag, int type, uint64_t value) {
    put(uint64_t(tag), 2), put(uint64_t(type), 2), put(1, offset), put(value, offset);
  };
  const size_t entryBytes = size_t(4 + 2 * offset);
  const size_t first = file.size() + size_t(offset);
  const size_t second = first + size_t(count) + 2 * entryBytes + size_t(offset);
  const size_t rational = second + size_t(count) + entryBytes + size_t(offset);
  put(first, offset), put(2, count);
  entry(274, 3, uint64_t(orientation)), entry(0x8769, pointerType, second), put(0, offset);
  put(1, count);
  if (isBig)
    entry(0x829a, 5, uint64_t(40) << 32 | 1);
  else
    entry(0x829a, 5, rational);
  put(0, offset);
  put(1, 4), put(40, 4);
  return file;
}

TEST(ImageHeaders, PointersOfEveryTypeLeadToExif) {
  const TemporaryFolder folder;
  for (const bool isBig : {false, true})
    for (const int type : {4, 13, 16, 18}) {
      if (!isBig && type >= 16) continue;
      const std::string file = directories(type, isBig, 6);
      const Exif exif = readExif(saved(folder / "a.tif", file));
      EXPECT_DOUBLE_EQ(exif.exposureTime.value_or(0), 1. / 40) << type << isBig;
      EXPECT_EQ(exifOrientation({reinterpret_cast<const uint8_t*>(file.data()), file.size()}), 6);
      for (size_t length = 0; length < file.size(); ++length)  // truncated
        readExif(saved(folder / "b.tif", file.substr(0, length)));
    }
}

TEST(ImageHeaders, NegativeChannelsAreCounted) {
  const TemporaryFolder folder;
  Image probe(16, 8, 3);
  probe.setRgb(3, 3, Rgb(1000));  // spherical harmonics ring around it
  writeImage(folder / "p.exr", probe);
  for (const char* name : {"a.hdr", "a.png", "a.exr"}) {
    const CommandResult result = runCommand({"probe", "irradiance", folder / "p.exr", folder / name,
                                             "--method", "sh", "--mapping", "lat-long"});
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.error.find("are negative, down to -") != std::string::npos,
              std::string(name) != "a.exr")
        << result.error;
  }
}

// RGBE ends before float does, and has no infinity.
TEST(ImageHeaders, NumbersBeyondRgbeAreCounted) {
  const TemporaryFolder folder;
  Image image(5, 2, 3);
  image.setRgb(0, 0, Rgb(kMaxRgbe, 1, 0));
  EXPECT_TRUE(writeImage(folder / "a.hdr", image).empty());
  EXPECT_EQ(readImage(folder / "a.hdr").rgb(0, 0).x, kMaxRgbe);
  image.setRgb(1, 0, Rgb(3e38f));
  image.setRgb(2, 1, Rgb(std::numeric_limits<float>::quiet_NaN(), 0, -1));
  const Messages warnings = writeImage(folder / "a.hdr", image);
  ASSERT_EQ(warnings.size(), 3u);
  const auto has = [&](size_t i, const char* text) {
    EXPECT_NE(warnings[i].text.find(text), std::string::npos) << warnings[i].text;
  };
  has(0, "3.33% of the channels are negative, down to -1, and become 0");
  has(1, "10% of the channels are above 1.69e+38, up to 3e+38, and are cut");
  has(2, "3.33% of the channels are NaN or infinite, and become 0");
  EXPECT_EQ(readImage(folder / "a.hdr").rgb(1, 0).x, kMaxRgbe);
  EXPECT_TRUE(writeImage(folder / "a.exr", image).empty());
  image.setRgb(4, 1, Rgb(std::numeric_limits<float>::infinity(), 0, 0));  // is white
  const Messages ofPng = writeImage(folder / "a.png", image);
  ASSERT_EQ(ofPng.size(), 2u);
  EXPECT_NE(ofPng[1].text.find("3.33% of the channels are NaN, and become 0"), std::string::npos);
}

// Light beyond alpha is lost in a .png where nothing covers the background.
TEST(ImageHeaders, ImagesWithoutColourAreNotWritten) {
  const TemporaryFolder folder;
  for (const char* name : {"a.exr", "a.hdr", "a.pfm", "a.png"})
    EXPECT_THROW(writeImage(folder / name, Image(2, 2, 2)), InputError) << name;
  EXPECT_TRUE(folder.files().empty());
}

TEST(ImageHeaders, LostAlphaIsNamed) {
  Image image(2, 1, 4);
  image.texels = {1, 1, 1, 1, 0.5f, 0.5f, 0.5f, 0.5f};
  for (const char* name : {"a.hdr", "a.pfm"}) {
    const Messages warnings = lostLight(name, image);
    ASSERT_EQ(warnings.size(), 1u) << name;
    EXPECT_NE(warnings[0].text.find("holds no alpha"), std::string::npos);
  }
  for (const char* name : {"a.exr", "a.png"}) EXPECT_TRUE(lostLight(name, image).empty()) << name;
  image.texels[7] = 1;
  EXPECT_TRUE(lostLight("a.hdr", image).empty());
}

TEST(ImageHeaders, UncoveredLightIsCounted) {
  Image image(4, 1, 4);  // black, an object, its bright edge, a caustic
  const std::array<std::array<float, 4>, 4> texels = {
      {{0, 0, 0, 0}, {5, 5, 5, 1}, {3, 3, 3, 0.75f}, {2, 2, 2, 0}}};
  for (int x = 0; x < 4; ++x) std::copy_n(texels[size_t(x)].begin(), 4, image.at(x, 0));
  const Messages warnings = lostLight("a.png", image);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].text.find("25% of the pixels, 20% of the image's"), std::string::npos)
      << warnings[0].text;
  EXPECT_TRUE(lostLight("a.exr", image).empty());
  std::fill_n(image.at(3, 0), 4, 0.0f);
  EXPECT_TRUE(lostLight("a.png", image).empty());
}

// An image that does not fit into the process's memory is refused by its header, at once.
TEST(SlowImageHeaders, ImagesLargerThanTheMemoryAreRefused) {
  if (kIsInstrumented) GTEST_SKIP() << kMeasuresMemory;
  const TemporaryFolder folder;
  const std::string pfm = folder / "a.pfm", hdr = folder / "a.hdr", exr = folder / "a.exr";
  std::ofstream(pfm) << "PF\n6000 3000\n-1\n";
  std::filesystem::resize_file(pfm, std::filesystem::file_size(pfm) + 12ull * 6000 * 3000);
  std::ofstream(hdr) << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 3000 +X 6000\n";
  std::filesystem::resize_file(hdr, std::filesystem::file_size(hdr) + 4ull * 6000 * 3000);
  const CommandLimits limits{.memory = 700'000'000};
  for (const std::string& file : {pfm, hdr})
    for (const std::vector<std::string>& words :
         std::vector<std::vector<std::string>>{{"image", "view", file, folder / "o.png"},
                                               {"probe", "info", file},
                                               {"probe", "convert", file, exr, "--to", "angular"},
                                               {"image", "error", file, file}})
      expectError(words, "6000 x 3000 texels with 3 channels take 0.648 GB", limits);
}

}  // namespace
}  // namespace chromeball::image_headers_test
