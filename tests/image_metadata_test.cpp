// SPDX-License-Identifier: Apache-2.0
// Metadata of image files is skipped, however damaged; JPEGs are checked before memory is
// allocated.
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "exif_block.h"
#include "gltf_writer.h"
#include "icc_file.h"
#include "image/io/color_space.h"
#include "image/io/decode_image.h"
#include "image/io/read_image.h"
#include "image/tonemap.h"
#include "instrumented.h"
#include "run_command.h"
#include "shared_data.h"

namespace chromeball::image_metadata_test {
namespace {

using Bytes = std::vector<uint8_t>;
using Words = std::vector<std::string>;

const CommandLimits kSmall{.memory = kIsInstrumented ? 0 : size_t(1) << 30};

Bytes seed(const std::string& name) {
  const std::string text =
      fileContents(std::string(kSourceDir) + "/tests/fuzz/seeds/image/" + name);
  EXPECT_FALSE(text.empty()) << name;
  return {text.begin(), text.end()};
}

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

Bytes text(const std::string& text) { return {text.begin(), text.end()}; }

Bytes bigEndian(uint64_t value, int bytes) {
  Bytes out;
  while (bytes-- > 0) out.push_back(uint8_t(value >> 8 * bytes));
  return out;
}

Bytes inserted(const Bytes& file, size_t at, const Bytes& more) {
  Bytes out = file;
  out.insert(out.begin() + std::ptrdiff_t(at), more.begin(), more.end());
  return out;
}

// An ICC profile whose only tag, a description, is two gigabytes beyond the end of the profile; the
// end of the tag, computed in 32 bits, is inside.
Bytes profile() {
  Bytes icc(128);
  const auto put = [&](size_t at, const Bytes& bytes) {
    std::copy(bytes.begin(), bytes.end(), icc.begin() + std::ptrdiff_t(at));
  };
  put(0, bigEndian(144, 4));
  put(12, text("mntrRGB XYZ "));
  put(36, text("acsp"));
  return joined(
      {icc, bigEndian(1, 4), text("desc"), bigEndian(0x80000000, 4), bigEndian(0x80000010, 4)});
}

Bytes segment(uint8_t marker, const Bytes& data) {
  return joined({{0xff, marker}, bigEndian(data.size() + 2, 2), data});
}

Bytes profileSegment() {
  return segment(0xe2, joined({text("ICC_PROFILE"), {0, 1, 1}, profile()}));
}

Bytes chunk(const std::string& type, const Bytes& data) {
  return joined({bigEndian(data.size(), 4), text(type), data, {1, 2, 3, 4}});
}

// The offset of the first frame header of a JPEG.
size_t frameOf(const Bytes& jpeg) {
  for (size_t at = 2; at + 4 < jpeg.size(); at += 2 + size_t(jpeg[at + 2] << 8 | jpeg[at + 3]))
    if (jpeg[at + 1] >= 0xc0 && jpeg[at + 1] <= 0xc2) return at;
  ADD_FAILURE() << "no frame";
  return 0;
}

// The little-endian TIFF with an additional directory entry; the directory moves to the end.
Bytes withTag(Bytes tiff, uint16_t tag, uint16_t type, const Bytes& data) {
  const auto number = [&](size_t at, int bytes) {
    uint32_t value = 0;
    while (bytes-- > 0) value = value << 8 | tiff[at + size_t(bytes)];
    return value;
  };
  const auto little = [](uint32_t value, int bytes) {
    Bytes out = bigEndian(value, bytes);
    std::reverse(out.begin(), out.end());
    return out;
  };
  const size_t directory = number(4, 4), count = number(directory, 2), first = directory + 2;
  size_t at = first;
  while (at < first + 12 * count && number(at, 2) < tag) at += 12;
  const Bytes entry = joined({little(tag, 2), little(type, 2), little(uint32_t(data.size()), 4),
                              little(uint32_t(tiff.size()), 4)});
  const auto part = [&](size_t from, size_t to) {
    return Bytes(tiff.begin() + std::ptrdiff_t(from), tiff.begin() + std::ptrdiff_t(to));
  };
  const Bytes moved = joined(
      {little(uint32_t(count + 1), 2), part(first, at), entry, part(at, first + 12 * count + 4)});
  const Bytes offset = little(uint32_t(tiff.size() + data.size()), 4);
  std::copy(offset.begin(), offset.end(), tiff.begin() + 4);
  return joined({tiff, data, moved});
}

std::string saved(const std::string& path, const Bytes& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  return path;
}

// The samples of a JPEG, or the reason why it is refused.
Bytes jpegSamples(const Bytes& jpeg) {
  const auto reader = openJpeg(jpeg, [](const SampleLayout&) {});
  const SampleLayout layout = reader->layout();
  Bytes samples;
  reader->read([&](int, const void* row) {
    const auto* from = static_cast<const uint8_t*>(row);
    samples.insert(samples.end(), from, from + layout.width * layout.channels);
  });
  return samples;
}

std::string jpegProblem(const Bytes& jpeg) {
  try {
    jpegSamples(jpeg);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(ImageMetadata, JpegUsesTheSegmentsThatDefineTheColourSpace) {
  const Bytes jpeg = seed("a.jpg");
  const Bytes adobe = segment(0xee, joined({text("Adobe"), Bytes(7)}));  // RGB, not YCbCr
  const size_t first = 4 + size_t(jpeg[4] << 8 | jpeg[5]);               // after the JFIF segment
  Bytes laden = jpeg;
  for (uint8_t marker = 0xe1; marker <= 0xef; ++marker)
    if (marker != 0xee) laden = inserted(laden, first, segment(marker, text("Exif and others")));
  laden = inserted(laden, first, segment(0xfe, text("comment")));
  laden = inserted(laden, first, profileSegment());
  EXPECT_EQ(jpegSamples(laden), jpegSamples(jpeg));
  EXPECT_NE(jpegSamples(inserted({0xff, 0xd8}, 2,
                                 joined({adobe, Bytes(jpeg.begin() + long(first), jpeg.end())}))),
            jpegSamples(jpeg));
}

TEST(ImageMetadata, AncillaryChunksOfAPngAreSkipped) {
  const size_t behindHeader = 8 + 25;
  Bytes laden = kPng;
  for (const char* type : {"iCCP", "eXIf", "tEXt", "zTXt", "iTXt", "gAMA", "zzzz"})
    laden = inserted(laden, behindHeader, chunk(type, Bytes(20)));
  laden = joined({laden, chunk("tEXt", Bytes(9))});
  EXPECT_EQ(decodeImage(laden, "a").texels8, decodeImage(kPng, "a").texels8);
}

TEST(ImageMetadata, DamagedMetadataOfATiffIsSkipped) {
  const TemporaryFolder folder;
  const Bytes tiff = seed("a.tif");
  const Image plain = readImage(saved(folder / "a.tif", tiff));
  Bytes laden = tiff;
  for (const uint16_t tag : {700, 33723, 34377, 34675}) laden = withTag(laden, tag, 7, profile());
  EXPECT_EQ(readImage(saved(folder / "b.tif", laden)).texels, plain.texels);
}

// Read as an image, as a probe, and as a texture at every location in a model.
TEST(ImageMetadata, DamagedProfilesAreIgnored) {
  const TemporaryFolder folder;
  const Bytes png = inserted(kPng, 8 + 25, chunk("iCCP", Bytes(40)));
  const std::vector<std::pair<std::string, Bytes>> files = {
      {"a.jpg", inserted(seed("a.jpg"), 2, profileSegment())},
      {"a.png", png},
      {"a.tif", withTag(seed("a.tif"), 34675, 7, profile())}};
  for (const auto& [name, bytes] : files) {
    const std::string path = saved(folder / name, bytes);
    const CommandResult view = runCommand({"image", "view", path, folder / "out.png"});
    EXPECT_EQ(view.status, 0) << name << ": " << view.error;
    const CommandResult info = runCommand({"probe", "info", path, "--mapping", "lat-long"});
    EXPECT_EQ(info.status, 0) << name << ": " << info.error;
  }
  const Bytes& jpeg = files[0].second;
  EXPECT_EQ(decodeImage(jpeg, "a").texels8, decodeImage(seed("a.jpg"), "a").texels8);
  EXPECT_EQ(decodeImage(png, "a").texels8, decodeImage(kPng, "a").texels8);
}

// The bytes as one stored block (RFC 1950 and 1951).
Bytes zlibOf(const Bytes& data) {
  uint32_t a = 1, b = 0;
  for (const uint8_t byte : data) a = (a + byte) % 65521, b = (b + a) % 65521;
  const auto little = [](uint64_t n) { return Bytes{uint8_t(n), uint8_t(n >> 8)}; };
  return joined({{0x78, 1, 1},
                 little(data.size()),
                 little(~data.size()),
                 data,
                 bigEndian(uint64_t(b) << 16 | a, 4)});
}

Bytes iccpChunk(const Bytes& profile, const std::string& name = "sRGB") {
  return chunk("iCCP", joined({text(name), {0, 0}, zlibOf(profile)}));
}

const char* const kNotApplied =
    "has a colour profile that is not applied; its colours are read as ";

class ImageProfile : public testing::Test {
 protected:
  ImageFile read(const std::string& name, const Bytes& bytes,
                 IntegerTexels integers = IntegerTexels::Srgb) const {
    return readImageFile(saved(folder_ / name, bytes), integers);
  }
  bool isSaid(const std::string& name, const Bytes& bytes,
              IntegerTexels integers = IntegerTexels::Srgb) const {
    return std::ranges::any_of(read(name, bytes, integers).messages, [](const Message& message) {
      return message.kind == Message::Kind::Warning &&
             message.text.find(kNotApplied) != std::string::npos;
    });
  }
  static Bytes jpeg(const Bytes& profile) {
    return inserted(seed("a.jpg"), 2,
                    segment(0xe2, joined({text("ICC_PROFILE"), {0, 1, 1}, profile})));
  }
  static Bytes png(const Bytes& chunks) { return inserted(kPng, 8 + 25, chunks); }
  static Bytes tiff(const Bytes& profile) { return withTag(seed("a.tif"), 34675, 7, profile); }

 private:
  TemporaryFolder folder_;
};

std::vector<int> srgbTable(int entries) {
  std::vector<int> table;
  for (int i = 0; i < entries; ++i)
    table.push_back(int(std::lround(65535 * srgbToLinear(float(i) / float(entries - 1)))));
  return table;
}

const Bytes kLinear = iccProfile(iccCurve({})),
            kAdobe = iccProfile(
                iccCurve({563}),
                {{.60974, .31111, .01947}, {.20528, .62567, .06087}, {.14919, .06322, .74457}}),
            kDisplayP3 = iccProfile(iccSrgbCurve(), kIccDisplayP3);

// By its curves and primaries, whatever it is called.
TEST_F(ImageProfile, IsNamedUnlessItSaysWhatIsRead) {
  const IccBytes curve = iccSrgbCurve();
  const std::vector<std::pair<Bytes, bool>> profiles = {
      {iccProfile(curve), false},
      {iccProfile(iccCurve(srgbTable(1024))), false},
      {iccProfile(iccCurve(srgbTable(42))), false},
      {iccProfile({{"kTRC", curve}}, "GRAY"), false},
      {kLinear, true},
      {iccProfile(iccCurve({256})), true},
      {iccProfile(iccParametric(0, {1})), true},
      {iccProfile(iccCurve({563})), true},
      {iccProfile(iccParametric(0, {2.2})), true},
      {iccProfile({{"kTRC", iccCurve({563})}}, "GRAY"), true},
      {kAdobe, true},
      {kDisplayP3, true},
      {iccProfile(curve, kIccSrgb, {{"A2B0", iccText("mft2")}}), true},  // tables
      {iccProfile({{"kTRC", curve}}, "CMYK"), true},
      {text("xx sRGB IEC61966-2.1"), true}};  // no profile
  for (size_t i = 0; i < profiles.size(); ++i) {
    const auto& [data, isOther] = profiles[i];
    EXPECT_EQ(isSaid("a.jpg", jpeg(data)), isOther) << i;
    EXPECT_FALSE(isSaid("a.jpg", jpeg(data), IntegerTexels::Linear)) << "a mask";
    EXPECT_EQ(isSaid("a.png", png(iccpChunk(data))), isOther) << i;
    EXPECT_EQ(isSaid("a.tif", tiff(data)), isOther) << i;
  }
  EXPECT_FALSE(isSaid("a.jpg", seed("a.jpg")));
  EXPECT_FALSE(isSaid("a.png", kPng));
  EXPECT_FALSE(isSaid("a.tif", seed("a.tif")));
}

// gAMA and cHRM are used; the profile, which has precedence, must agree with them.
TEST_F(ImageProfile, OfAPngIsComparedWithItsChunks) {
  const auto gamma = [](uint32_t n) { return chunk("gAMA", bigEndian(n, 4)); };
  Bytes p3;
  for (const uint32_t n : {31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000})
    p3 = joined({p3, bigEndian(n, 4)});
  const Bytes asSrgb = gamma(45455), primaries = chunk("cHRM", p3);
  const auto isSaidOf = [&](const Bytes& profile, const Bytes& chunks) {
    return isSaid("a.png", png(joined({iccpChunk(profile), chunks})));
  };
  EXPECT_TRUE(isSaidOf(kDisplayP3, asSrgb));
  EXPECT_TRUE(isSaidOf(kDisplayP3, primaries) != isSaidOf(kDisplayP3, {}));
  EXPECT_FALSE(isSaidOf(kDisplayP3, joined({asSrgb, primaries})));
  EXPECT_TRUE(isSaidOf(kAdobe, asSrgb));
  EXPECT_TRUE(isSaidOf(kAdobe, joined({asSrgb, primaries})));
  EXPECT_FALSE(isSaidOf(kLinear, gamma(100000)));
  EXPECT_TRUE(isSaidOf(kLinear, asSrgb));
  EXPECT_TRUE(isSaidOf(kLinear, chunk("sRGB", {0})));
  EXPECT_FALSE(isSaidOf(kDisplayP3, chunk("cICP", {12, 13, 0, 1}))) << "has precedence over it";
  EXPECT_TRUE(isSaid("a.png", png(joined({chunk("iCCP", Bytes(40)), asSrgb})))) << "damaged";
  EXPECT_TRUE(isSaid("a.png", png(iccpChunk(Bytes(3 << 10)))));
}

// Of photographs, whose response it is.
TEST_F(ImageProfile, TellsTheTransferOfLevels) {
  const auto transferOf = [&](const Bytes& profile) {
    const std::optional<Transfer> ofTiff =
        read("a.tif", tiff(profile), IntegerTexels::Levels).transfer;
    EXPECT_EQ(read("a.jpg", jpeg(profile), IntegerTexels::Levels).transfer, ofTiff);
    EXPECT_EQ(read("a.png", png(iccpChunk(profile)), IntegerTexels::Levels).transfer, ofTiff);
    return ofTiff;
  };
  EXPECT_EQ(transferOf(iccProfile(iccSrgbCurve())), Transfer::Srgb);
  EXPECT_EQ(transferOf(kDisplayP3), Transfer::Srgb);
  EXPECT_EQ(transferOf(kLinear), Transfer::Linear);
  EXPECT_EQ(transferOf(kAdobe), std::nullopt);
  EXPECT_FALSE(isSaid("a.tif", tiff(kLinear), IntegerTexels::Levels));
  EXPECT_TRUE(isSaid("a.tif", tiff(kDisplayP3), IntegerTexels::Levels));
}

TEST(IccProfile, DamagedOnesAgreeWithNothing) {
  const auto isSrgb = [](const Bytes& bytes) {
    const IccProfile profile(bytes);
    return profile.decodesBy(srgbToLinear) && profile.has({});
  };
  const Bytes whole = iccProfile(iccCurve(srgbTable(64)));
  EXPECT_TRUE(isSrgb(whole));
  for (size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(isSrgb(Bytes(whole.begin(), whole.begin() + long(size)))) << size;
  }
  for (size_t i = 128; i < whole.size(); ++i)
    for (const uint8_t byte : {0, 0x7f, 0xff}) {
      Bytes damaged = whole;
      damaged[i] = byte;
      isSrgb(damaged);  // must not crash
    }
  for (int kind = 0; kind < 6; ++kind)
    for (const double number : {0., -1., 32767., -32768.})
      EXPECT_FALSE(isSrgb(iccProfile(iccParametric(kind, std::vector<double>(7, number)))));
}

// ICC.1, annex B.4. The tables of the second part say what the first does not.
TEST_F(ImageProfile, PartsOfAJpegAreJoinedByTheirNumbers) {
  const auto inParts = [](const Bytes& profile) {
    const auto middle = profile.begin() + std::ptrdiff_t(profile.size() / 2);
    const auto part = [](uint8_t number, const Bytes& data) {
      return segment(0xe2, joined({text("ICC_PROFILE"), {0, number, 2}, data}));
    };
    return inserted(seed("a.jpg"), 2,
                    joined({part(2, {middle, profile.end()}), part(1, {profile.begin(), middle})}));
  };
  EXPECT_FALSE(isSaid("srgb.jpg", inParts(iccProfile(iccCurve(srgbTable(1024))))));
  EXPECT_TRUE(isSaid("gamma.jpg", inParts(iccProfile(iccCurve(std::vector<int>(1024, 9000))))));
}

// Photographs to be merged are not read as sRGB.
TEST_F(ImageProfile, OfLevelsSaysNoCurve) {
  const Messages messages = read("a.jpg", jpeg(kAdobe), IntegerTexels::Levels).messages;
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_NE(messages.front().text.find("read as those of Rec. 709"), std::string::npos);
}

// Cameras that are set to Adobe RGB state that in EXIF's ColorSpace, often only there.
TEST(ImageMetadata, ColoursOfExifThatAreNotAppliedAreNamed) {
  constexpr uint16_t kColorSpace = 0xa001;
  const TemporaryFolder folder;
  const auto isSaid = [&](const Bytes& bytes, IntegerTexels integers = IntegerTexels::Srgb) {
    const Messages messages = readImageFile(saved(folder / "a", bytes), integers).messages;
    return std::ranges::any_of(messages, [](const Message& message) {
      return message.text.find("states other colours than those of sRGB") != std::string::npos;
    });
  };
  const Bytes jpeg = seed("a.jpg"), tiff = seed("a.tif");
  for (const auto& [space, isOther] : {std::pair{1, false}, {2, true}, {65535, true}}) {
    const std::string block = exifBlock({{kColorSpace, uint32_t(space), 0}});
    const std::string file = withExif({jpeg.begin(), jpeg.end()}, block);
    const Bytes photograph(file.begin(), file.end());
    EXPECT_EQ(isSaid(photograph), isOther) << space;
    EXPECT_FALSE(isSaid(photograph, IntegerTexels::Linear));
    const Bytes profile = joined({text("ICC_PROFILE"), {0, 1, 1}, iccProfile(iccSrgbCurve())});
    EXPECT_FALSE(isSaid(inserted(photograph, 2, segment(0xe2, profile))));  // tells more
  }
  const std::string noColors = withExif({jpeg.begin(), jpeg.end()}, exifBlock({isoSpeed(100)}));
  EXPECT_FALSE(isSaid({noColors.begin(), noColors.end()}));
  EXPECT_FALSE(isSaid(jpeg));
  EXPECT_FALSE(isSaid(tiff));
}

// Models with the texture `jpeg`: in a file, in a data URI and in a buffer view.
std::vector<nlohmann::json> imagesOf(GltfWriter& model, const Bytes& jpeg) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  model.write("a.jpg", jpeg);
  std::string uri = "data:image/jpeg;base64,";
  Bytes padded = jpeg;
  while (padded.size() % 3) padded.push_back(0);
  for (size_t i = 0; i < padded.size(); i += 3) {
    const uint32_t three = uint32_t(padded[i] << 16 | padded[i + 1] << 8 | padded[i + 2]);
    for (int shift = 18; shift >= 0; shift -= 6) uri += kDigits[three >> shift & 63];
  }
  return {{{"uri", "a.jpg"}},
          {{"uri", uri}},
          {{"bufferView", model.view(jpeg)}, {"mimeType", "image/jpeg"}}};
}

TEST(SlowImageMetadata, TexturesOfModels) {
  const Bytes damaged = inserted(seed("a.jpg"), 2, profileSegment());
  Bytes bomb = damaged;
  const size_t frame = frameOf(bomb);
  bomb[frame + 1] = 0xc2;  // progressive
  std::fill_n(bomb.begin() + std::ptrdiff_t(frame) + 5, 4, uint8_t(0xfc));
  for (int location = 0; location < 3; ++location)
    for (const bool isBomb : {false, true}) {
      GltfWriter model;
      model.add("images", imagesOf(model, isBomb ? bomb : damaged)[size_t(location)]);
      model.add("textures", {{"source", 0}});
      model.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
      addTriangle(model, {{"material", 0}});
      const std::string probe =
          saved((model.folder() / "p.pfm").string(), joined({text("PF\n1 1\n-1\n"), Bytes(12)}));
      const Words words = {"render",
                           model.save(),
                           "--probe",
                           probe,
                           "--probe-mapping",
                           "lat-long",
                           "--size",
                           "8x8",
                           "--samples",
                           "1",
                           "--quiet",
                           "-o",
                           (model.folder() / "out.pfm").string()};
      if (isBomb) {
        expectError(words, "64764 x 64764 texels cannot fit into", kSmall);
      } else {
        const CommandResult result = runCommand(words);
        EXPECT_EQ(result.status, 0) << location << ": " << result.error;
      }
    }
}

// All kinds of frames that libjpeg reads, behind metadata, before memory is allocated.
TEST(SlowImageMetadata, JpegFramesAreCheckedFirst) {
  const TemporaryFolder folder;
  const Bytes jpeg = seed("a.jpg");
  const size_t frame = frameOf(jpeg);
  for (int kind = 0xc0; kind <= 0xcf; ++kind) {
    if (kind == 0xc4 || kind == 0xc8 || kind == 0xcc) continue;  // not frames
    Bytes bomb = inserted(jpeg, 2, profileSegment());
    const size_t at = frame + profileSegment().size();
    bomb[at + 1] = uint8_t(kind);
    std::fill_n(bomb.begin() + std::ptrdiff_t(at) + 5, 4, uint8_t(0xfc));
    const bool isRead = kind <= 0xc2 || kind == 0xc9 || kind == 0xca;
    const char* reason = isRead ? "64764 x 64764" : "Unsupported";
    const std::string path = saved(folder / "bomb.jpg", bomb);
    expectError({"image", "view", path, folder / "out.png"}, reason, kSmall);
    expectError({"probe", "info", path}, reason, kSmall);
  }
  // An image that is too large is rejected even if the file has enough bytes.
  Bytes large = jpeg;
  large[frame + 1] = 0xc2;
  std::fill_n(large.begin() + std::ptrdiff_t(frame) + 5, 4, uint8_t(0xfc));
  large.resize(9 << 20);
  expectError({"probe", "info", saved(folder / "large.jpg", large)}, "exceed the limit", kSmall);
  EXPECT_THROW(decodeImage(large, "large"), InputError);
  // A file with a truncated frame header.
  EXPECT_NE(jpegProblem(Bytes(jpeg.begin(), jpeg.begin() + std::ptrdiff_t(frame) + 8)), "");
}

TEST(ImageMetadata, JpegWithTooManyScansIsRejected) {
  const Bytes jpeg = seed("a.jpg");
  // A progressive image of empty scans: each refines the first coefficient of the first component.
  const size_t frame = frameOf(jpeg);
  Bytes head(jpeg.begin(), jpeg.end());
  head[frame + 1] = 0xc2;
  size_t scan = frame;
  while (head[scan + 1] != 0xda) scan += 2 + size_t(head[scan + 2] << 8 | head[scan + 3]);
  head.resize(scan);
  const auto withScans = [&](int count) {
    Bytes bytes = joined({head, segment(0xda, {1, 1, 0, 0, 0, 0x01}), {0}});
    for (int i = 1; i < count; ++i)
      bytes = joined({bytes, segment(0xda, {1, 1, 0, 0, 0, 0x10}), {0}});
    return joined({bytes, {0xff, 0xd9}});
  };
  EXPECT_EQ(jpegProblem(withScans(kMaxJpegScans)), "");
  EXPECT_EQ(jpegProblem(withScans(kMaxJpegScans + 1)), "more than 100 scans");
  // Bytes after the end of the image are ignored.
  Bytes followed = jpeg;
  for (int i = 0; i < 200; ++i) followed = joined({followed, segment(0xda, {1, 1, 0, 0, 0, 0})});
  EXPECT_EQ(jpegProblem(followed), "");
}

TEST(SlowImageMetadata, FilesFromFuzzing) {
  const auto folder = sharedData("hostile");
  if (!folder) GTEST_SKIP() << "no ../shared/data/hostile";
  const std::string bomb = (*folder / "bomb-progressive-65500x65500.jpg").string();
  const TemporaryFolder out;
  expectError({"probe", "info", bomb}, "65500 x 65500 texels cannot fit into 522 bytes", kSmall);
  const std::string damaged = (*folder / "corrupt-icc-4551.jpg").string();
  const CommandResult result = runCommand({"image", "view", damaged, out / "a.png"});
  EXPECT_TRUE(result.status == 0 || result.status == 2) << result.status << result.error;
}

}  // namespace
}  // namespace chromeball::image_metadata_test
