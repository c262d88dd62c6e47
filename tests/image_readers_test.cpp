// SPDX-License-Identifier: Apache-2.0
// The readers of PNG and JPEG against OpenImageIO's, on files of every kind that these formats
// have, whole and truncated. OpenImageIO makes up the missing part of a JPEG; we refuse the file.
#include <gtest/gtest.h>

#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <fstream>
#include <random>
#include <stdexcept>
#include <system_error>

// needs size_t and FILE
#include <jpeglib.h>
#include <png.h>

#include "base/error.h"
#include "image/io/decode_image.h"
#include "image/io/image_format.h"
#include "image/io/imageio_module.h"
#include "image/io/read_image.h"
#include "run_command.h"

namespace chromeball::image_readers_test {
namespace {

// A file is at fault only for what its bytes say.
TEST(ImageReaders, ScarceMemoryAndThreadsAreNoFaultOfTheFile) {
  const auto read = [](const auto& error) { readByLibrary("a.exr", [&] { throw error; }); };
  EXPECT_THROW(read(std::bad_alloc()), RunError);
  EXPECT_THROW(read(std::system_error(EAGAIN, std::generic_category())), RunError);
  EXPECT_THROW(read(std::runtime_error("bad magic")), InputError);
}

using Bytes = std::vector<uint8_t>;

Bytes randomBytes(size_t count, uint32_t seed) {
  std::mt19937 random(seed);
  Bytes bytes(count);
  for (uint8_t& byte : bytes) byte = uint8_t(random());
  return bytes;
}

struct PngKind {
  int color, bits;
  bool interlaced = false, transparent = false;  // transparent: tRNS
  const char* chunk = nullptr;                   // an ancillary one
};

Bytes makePng(const PngKind& kind, int width, int height) {
  Bytes file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &file,
      [](png_structp p, png_bytep data, size_t count) {
        auto& to = *static_cast<Bytes*>(png_get_io_ptr(p));
        to.insert(to.end(), data, data + count);
      },
      nullptr);
  png_set_IHDR(png, info, png_uint_32(width), png_uint_32(height), kind.bits, kind.color,
               kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, 0, 0);
  const int colors = 1 << std::min(kind.bits, 8);
  if (kind.color == PNG_COLOR_TYPE_PALETTE) {
    const Bytes palette = randomBytes(size_t(colors) * 3, 1);
    png_set_PLTE(png, info, reinterpret_cast<png_const_colorp>(palette.data()), colors);
  }
  const Bytes alpha = randomBytes(256, 2);
  png_color_16 key{1, 1, 1, 1, 1};
  if (kind.transparent) png_set_tRNS(png, info, alpha.data(), std::max(colors / 2, 1), &key);
  const std::string chunk = kind.chunk ? kind.chunk : "";
  if (chunk == "gAMA") png_set_gAMA_fixed(png, info, 100000);
  png_write_info(png, info);
  const size_t rowBytes = png_get_rowbytes(png, info);
  const int passes = png_set_interlace_handling(png);
  const Bytes texels = randomBytes(rowBytes * size_t(height), 3);
  for (int pass = 0; pass < passes; ++pass)
    for (int y = 0; y < height; ++y) png_write_row(png, &texels[size_t(y) * rowBytes]);
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return file;
}

struct JpegKind {
  J_COLOR_SPACE stored;
  int components;
  bool progressive = false;
  int restart = 0;   // interval, in rows of blocks
  int sampling = 1;  // of the luminance: 2 halves the chroma
};

Bytes makeJpeg(const JpegKind& kind, int width, int height) {
  jpeg_compress_struct jpeg = {};
  jpeg_error_mgr errors;
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* memory = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &memory, &size);
  jpeg.image_width = JDIMENSION(width);
  jpeg.image_height = JDIMENSION(height);
  jpeg.input_components = kind.components;
  jpeg.in_color_space = kind.components == 1   ? JCS_GRAYSCALE
                        : kind.components == 3 ? JCS_RGB
                                               : JCS_CMYK;
  jpeg_set_defaults(&jpeg);
  jpeg_set_colorspace(&jpeg, kind.stored);
  if (kind.components >= 3)
    jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = kind.sampling;
  if (kind.components == 4)
    jpeg.comp_info[3].h_samp_factor = jpeg.comp_info[3].v_samp_factor = kind.sampling;
  jpeg.restart_in_rows = kind.restart;
  if (kind.progressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  const size_t rowBytes = size_t(width) * size_t(kind.components);
  Bytes texels = randomBytes(rowBytes * size_t(height), 4);
  for (int y = 0; y < height; ++y) {
    uint8_t* row = &texels[size_t(y) * rowBytes];
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  const Bytes file(memory, memory + size);
  jpeg_destroy_compress(&jpeg);
  std::free(memory);
  return file;
}

// The image read: fractions, with associated alpha; empty: refused.
std::vector<float> byModule(const char* format, const Bytes& file) try {
  const auto image = openModuleImage(format, file, "a file");
  const ModuleImageHeader& header = image->header();
  const int channels = int(header.channels.size()), alpha = header.alphaChannel;
  std::vector<float> texels(size_t(header.width) * size_t(header.height) * size_t(channels));
  image->read(texels.data());
  for (size_t i = 0; alpha >= 0 && i < texels.size(); i += size_t(channels))
    for (int c = 0; c < alpha; ++c) texels[i + size_t(c)] *= texels[i + size_t(alpha)];
  return texels;
} catch (const std::runtime_error&) {
  return {};
}

std::vector<float> byOurs(const Bytes& file, const TemporaryFolder& folder) try {
  const std::string path = folder / "image";
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(file.data()), std::streamsize(file.size()));
  return readImageFile(path, IntegerTexels::Linear).image.texels;
} catch (const InputError& error) {
  EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  return {};
}

Bytes firstOf(const Bytes& file, size_t count) {
  return {file.begin(), file.begin() + std::ptrdiff_t(count)};
}

void expectSameTexels(const char* format, const Bytes& file, const std::string& what) {
  const TemporaryFolder folder;
  const std::vector<float> texels = byOurs(file, folder);
  EXPECT_FALSE(texels.empty()) << what;
  EXPECT_EQ(texels, byModule(format, file)) << what;
}

// Cut at several places before `end`.
std::vector<Bytes> cutFiles(const Bytes& file, size_t end) {
  std::vector<Bytes> cuts;
  for (size_t i = 1; i < 16; ++i) cuts.push_back(firstOf(file, end * i / 16));
  return cuts;
}

TEST(ImageReaders, PngOfEveryKind) {
  std::vector<PngKind> kinds;
  for (const int bits : {1, 2, 4, 8, 16})
    for (const bool transparent : {false, true})
      kinds.push_back({PNG_COLOR_TYPE_GRAY, bits, false, transparent});
  for (const int bits : {1, 2, 4, 8})
    for (const bool transparent : {false, true})
      kinds.push_back({PNG_COLOR_TYPE_PALETTE, bits, false, transparent});
  for (const int bits : {8, 16}) {
    kinds.push_back({PNG_COLOR_TYPE_GRAY_ALPHA, bits});
    kinds.push_back({PNG_COLOR_TYPE_RGB, bits});
    kinds.push_back({PNG_COLOR_TYPE_RGB, bits, false, true});
    kinds.push_back({PNG_COLOR_TYPE_RGB_ALPHA, bits});
  }
  for (PngKind kind : kinds)
    for (const bool interlaced : {false, true}) {
      kind.interlaced = interlaced;
      const Bytes file = makePng(kind, 19, 13);
      constexpr size_t kEndChunk = 12;  // without which OpenImageIO refuses interlaced files only
      const std::string what = fmt::format("colour {}, {} bits, interlaced {}, transparent {}",
                                           kind.color, kind.bits, interlaced, kind.transparent);
      expectSameTexels("png", file, what);
      const TemporaryFolder folder;
      for (const Bytes& cut : cutFiles(file, file.size() - kEndChunk))
        EXPECT_EQ(byOurs(cut, folder), byModule("png", cut)) << what << ", " << cut.size();
    }
}

std::vector<JpegKind> jpegKinds() {
  std::vector<JpegKind> kinds;
  for (const bool progressive : {false, true})
    for (const int restart : {0, 1}) {
      kinds.push_back({JCS_GRAYSCALE, 1, progressive, restart});
      kinds.push_back({JCS_RGB, 3, progressive, restart});
      kinds.push_back({JCS_CMYK, 4, progressive, restart});
      for (const int sampling : {1, 2}) {
        kinds.push_back({JCS_YCbCr, 3, progressive, restart, sampling});
        kinds.push_back({JCS_YCCK, 4, progressive, restart, sampling});
      }
    }
  return kinds;
}

std::string inWords(const JpegKind& kind) {
  return fmt::format("colour {}, progressive {}, restart {}, sampling {}", int(kind.stored),
                     kind.progressive, kind.restart, kind.sampling);
}

TEST(ImageReaders, JpegOfEveryKind) {
  for (const JpegKind& kind : jpegKinds())
    expectSameTexels("jpeg", makeJpeg(kind, 37, 29), inWords(kind));
}

// Half a picture of any kind is refused, also as a texture.
TEST(ImageReaders, TruncatedJpegIsRefused) {
  const TemporaryFolder folder;
  constexpr size_t kEndMarker = 2;
  for (const JpegKind& kind : jpegKinds()) {
    const Bytes file = makeJpeg(kind, 37, 29);
    std::vector<Bytes> cuts = cutFiles(file, file.size());
    cuts.push_back(firstOf(file, file.size() - kEndMarker - 1));
    for (const Bytes& cut : cuts) {
      EXPECT_TRUE(byOurs(cut, folder).empty()) << inWords(kind) << ", " << cut.size();
      EXPECT_THROW(decodeImage(cut, "a"), InputError);
    }
  }
}

// A file with all bits of its only scan; if it had several, others might be missing.
TEST(ImageReaders, JpegWithoutItsEndMarker) {
  const TemporaryFolder folder;
  constexpr size_t kEndMarker = 2;
  for (const JpegKind& kind : jpegKinds()) {
    const Bytes file = makeJpeg(kind, 37, 29);
    EXPECT_EQ(byOurs(firstOf(file, file.size() - kEndMarker), folder),
              kind.progressive ? std::vector<float>() : byOurs(file, folder))
        << inWords(kind);
  }
}

TEST(ImageReaders, DamagedJpegIsRefused) {
  const TemporaryFolder folder;
  const Bytes file = makeJpeg({JCS_YCbCr, 3}, 64, 64);
  Bytes damaged = file;
  damaged[file.size() / 2] = 0xff, damaged[file.size() / 2 + 1] = 0xd9;  // an end in the middle
  EXPECT_TRUE(byOurs(damaged, folder).empty());
  // Bytes that are skipped between segments, and after the end, are harmless.
  Bytes padded = file;
  constexpr size_t kStart = 2, kMarker = 2;
  const size_t segment = kStart + kMarker + (size_t(file[4]) << 8 | file[5]);
  padded.insert(padded.begin() + std::ptrdiff_t(segment), {0, 0, 0});
  padded.insert(padded.end(), {1, 2, 3});
  EXPECT_EQ(byOurs(padded, folder), byOurs(file, folder));
}

// glTF, 3.8.2: textures ignore colour spaces that an image states.
TEST(ImageReaders, TexturesIgnoreGamma) {
  const PngKind plain{PNG_COLOR_TYPE_RGB, 8}, linear{PNG_COLOR_TYPE_RGB, 8, false, false, "gAMA"};
  EXPECT_EQ(decodeImage(makePng(linear, 9, 5), "a").texels8,
            decodeImage(makePng(plain, 9, 5), "b").texels8);
}

}  // namespace
}  // namespace chromeball::image_readers_test
