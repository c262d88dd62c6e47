// SPDX-License-Identifier: Apache-2.0
#include "image/io/encode_png.h"

#include <png.h>

#include <csetjmp>
#include <cstring>

#include "base/error.h"

namespace chromeball {
namespace {

// What libpng's callbacks share. libpng ends by a jump in case of an error, so these have no
// destructors to run when it jumps.
struct PngOutput {
  std::vector<uint8_t>* bytes;
  char error[256];
};

void onPngError(png_structp png, png_const_charp message) {
  auto& output = *static_cast<PngOutput*>(png_get_error_ptr(png));
  std::strncpy(output.error, message, sizeof(output.error) - 1);
  png_longjmp(png, 1);
}

void onPngWarning(png_structp, png_const_charp) {}

void appendPngBytes(png_structp png, png_bytep data, size_t count) {
  std::vector<uint8_t>& bytes = *static_cast<PngOutput*>(png_get_io_ptr(png))->bytes;
  bytes.insert(bytes.end(), data, data + count);
}

bool writePngImage(png_structp png, png_infop info, int width, int height, int channels,
                   const uint8_t* bytes) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_IHDR(png, info, png_uint_32(width), png_uint_32(height), 8,
               channels == 1   ? PNG_COLOR_TYPE_GRAY
               : channels == 3 ? PNG_COLOR_TYPE_RGB
                               : PNG_COLOR_TYPE_RGB_ALPHA,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(png, 6);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_ABSOLUTE);
  png_write_info(png, info);
  for (int y = 0; y < height; ++y)
    png_write_row(png, bytes + size_t(y) * size_t(width) * size_t(channels));
  png_write_end(png, info);
  return true;
}

}  // namespace

std::vector<uint8_t> encodePng(int width, int height, int channels,
                               std::span<const uint8_t> bytes) {
  std::vector<uint8_t> encoded;
  PngOutput output{&encoded, {}};
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, &output, onPngError, onPngWarning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  bool written = false;
  if (info) {
    png_set_write_fn(png, &output, appendPngBytes, nullptr);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    written = writePngImage(png, info, width, height, channels, bytes.data());
  }
  png_destroy_write_struct(&png, &info);
  if (!written) throwRun("cannot encode a PNG: {}", output.error);
  return encoded;
}

}  // namespace chromeball
