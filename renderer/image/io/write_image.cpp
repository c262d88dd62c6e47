// SPDX-License-Identifier: Apache-2.0
#include "image/io/write_image.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csetjmp>
#include <cstring>

#include "base/error.h"
#include "base/file.h"
#include "base/parallel.h"
#include "base/text.h"
#include "image/io/exr_rows.h"
#include "image/io/pfm.h"
#include "image/io/radiance_hdr.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

// Colour in a PNG is unassociated; black where alpha is 0. This comes before the tone curve, which
// is not linear.
Rgb unassociated(const Rgb& color, float alpha) { return alpha > 0 ? color / alpha : Rgb(0); }

// Repeats grey in three channels.
Image repeated(const Image& grey) {
  Image color(grey.width, grey.height, 3);
  for (size_t i = 0; i < grey.pixels(); ++i) color.setRgb(i, Rgb(*grey.at(i)));
  return color;
}

// A line break in the name would end the comment, and a long one the header.
HdrComments mappingOf(const Metadata& metadata) {
  const auto found = metadata.find(kMappingAttribute);
  const auto* name = found == metadata.end() ? nullptr : std::get_if<std::string>(&found->second);
  if (!name || printableName(*name) != *name) return {};
  return {{kMappingAttribute, *name}};
}

// The formats that hold only the colour.
Messages writeColor(const fs::path& path, const Image& color, const DisplayTransform& transform,
                    const Metadata& metadata = {}) {
  if (color.channels < 3) return writeColor(path, repeated(color), transform, metadata);
  const std::string kind = lowerExtension(path);
  if (kind == ".hdr")
    writeRadianceHdr(path, color, mappingOf(metadata));
  else if (kind == ".pfm")
    writePfm(path, color);
  else
    writeFile(path, encodePng(color, transform));
  return lostLight(path, color);
}

bool isOpaque(const Image& color) {
  for (size_t i = 3; i < color.texels.size(); i += 4)
    if (color.texels[i] != 1) return false;
  return true;
}

std::optional<Message> uncoveredLight(const std::filesystem::path& path, const Image& color) {
  constexpr float kVisible = 1.0f / 255;
  size_t pixels = 0;
  double lost = 0, light = 0;
  for (size_t i = 0; i < color.pixels(); ++i) {
    const Rgb rgb = color.rgb(i);
    const float alpha = std::clamp(color.at(i)[3], 0.0f, 1.0f);
    light += luminance(rgb);
    if (alpha >= 0.5f || !(maxComponent(rgb) > alpha + kVisible)) continue;
    ++pixels;
    lost += luminance(glm::max(rgb - Rgb(alpha), Rgb(0)));
  }
  if (pixels == 0) return {};
  return makeWarning(
      "{}: loses light on {:.2g}% of the pixels, {:.2g}% of the image's: a .png has no color "
      "beyond its alpha, and nothing covers the background there; an .exr holds it",
      path.string(), 100. * double(pixels) / (double(color.width) * color.height),
      100 * lost / light);
}

// The numbers in the colour's channels that the format cannot hold. Light above white, also
// infinite light, is not reported for a .png: it is clipped like any bright surface.
Messages numbersLost(const fs::path& path, const Image& color, bool isHdr) {
  const int channels = std::min(color.channels, 3);
  size_t negative = 0, tooLarge = 0, infinite = 0, nan = 0;
  float least = 0, largest = 0;
  for (size_t i = 0; i < color.pixels(); ++i)
    for (int c = 0; c < channels; ++c) {
      const float number = color.at(i)[c];
      negative += number<0, tooLarge += number> kMaxRgbe;
      infinite += std::isinf(number), nan += std::isnan(number);
      least = std::min(least, number), largest = std::max(largest, number);
    }
  Messages messages;
  const auto add = [&](size_t numbers, const std::string& what) {
    if (numbers > 0)
      addWarning(messages, "{}: {:.3g}% of the channels are {}; an .exr holds them", path.string(),
                 100. * double(numbers) / double(color.pixels() * size_t(channels)), what);
  };
  add(negative, fmt::format("negative, down to {:.3g}, and become 0", least));
  if (!isHdr) {
    add(nan, "NaN, and become 0");
    return messages;
  }
  add(tooLarge, fmt::format("above {:.3g}, up to {:.3g}, and are cut", kMaxRgbe, largest));
  add(nan + infinite, "NaN or infinite, and become 0");
  return messages;
}

// The data that libpng's callbacks share. libpng ends by a jump in case of an error, so these have
// no destructors to run when it jumps.
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
                   const uint8_t* bytes, png_textp text) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_IHDR(png, info, png_uint_32(width), png_uint_32(height), 8,
               channels == 1   ? PNG_COLOR_TYPE_GRAY
               : channels == 3 ? PNG_COLOR_TYPE_RGB
                               : PNG_COLOR_TYPE_RGB_ALPHA,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(png, 6);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_ABSOLUTE);
  if (text) png_set_text(png, info, text, 1);
  png_write_info(png, info);
  for (int y = 0; y < height; ++y)
    png_write_row(png, bytes + size_t(y) * size_t(width) * size_t(channels));
  png_write_end(png, info);
  return true;
}

}  // namespace

std::vector<uint8_t> encodePng(const Image& color, const DisplayTransform& transform) {
  if (color.channels < 3) return encodePng(repeated(color), transform);
  const auto byte = [](float encoded) { return uint8_t(std::lround(255 * encoded)); };
  const bool hasAlpha = color.channels == 4;
  std::vector<uint8_t> bytes(size_t(color.width) * color.height * (hasAlpha ? 4 : 3));
  forRows(color.width, color.height, [&](int y) {
    uint8_t* to = bytes.data() + bytes.size() / size_t(color.height) * size_t(y);
    for (int x = 0; x < color.width; ++x) {
      const float alpha = hasAlpha ? std::clamp(color.at(x, y)[3], 0.0f, 1.0f) : 1;
      const Rgb shown = display(transform, unassociated(color.rgb(x, y), alpha));
      for (int c = 0; c < 3; ++c) *to++ = byte(linearToSrgb(shown[c]));
      if (hasAlpha) *to++ = byte(alpha);
    }
  });
  const std::string exposure =
      transform.exposure == 0 ? "" : fmt::format("{:g}", transform.exposure);
  return encodePng(color.width, color.height, hasAlpha ? 4 : 3, bytes, exposure);
}

void checkImageName(const fs::path& path) {
  constexpr std::array kExtensions = {".exr", ".hdr", ".pfm", ".png"};
  if (std::find(kExtensions.begin(), kExtensions.end(), lowerExtension(path)) == kExtensions.end())
    throwInput("{}: unknown image format; the name must end in .exr, .hdr, .pfm or .png",
               path.string());
}

void checkWritable(const fs::path& path) {
  checkImageName(path);
  checkReplaceable(path);
}

Messages writeImage(const fs::path& path, const OutputImage& output,
                    const DisplayTransform& transform) {
  checkWritable(path);
  if (lowerExtension(path) != ".exr")
    return writeColor(path, output.layers.front().image, transform, output.metadata);
  writeExr(path, output);
  return {};
}

Messages writeImage(const fs::path& path, const Image& color, const DisplayTransform& transform) {
  checkWritable(path);
  if (color.channels != 1 && color.channels != 3 && color.channels != 4)
    throwInput("{}: an image of {} channels is no colour; it needs 1, 3 or 4", path.string(),
               color.channels);
  if (lowerExtension(path) != ".exr") return writeColor(path, color, transform);
  const char* letters = color.channels >= 4 ? "RGBA" : color.channels == 3 ? "RGB" : "Y";
  writeExr(path, OutputImage{{{"", letters, color}}, {}, {}, {}});
  return {};
}

Messages lostLight(const std::filesystem::path& path, const Image& color) {
  const std::string kind = lowerExtension(path);
  Messages messages;
  if ((kind == ".hdr" || kind == ".pfm") && color.channels == 4 && !isOpaque(color))
    addWarning(messages, "{}: holds no alpha, which is lost; an .exr or a .png does",
               path.string());
  if (kind == ".png" && color.channels == 4)
    if (std::optional<Message> message = uncoveredLight(path, color))
      messages.push_back(*std::move(message));
  if (kind == ".png" || kind == ".hdr")
    for (Message& message : numbersLost(path, color, kind == ".hdr"))
      messages.push_back(std::move(message));
  return messages;
}

std::vector<uint8_t> encodePng(int width, int height, int channels, std::span<const uint8_t> bytes,
                               std::string exposure) {
  std::vector<uint8_t> encoded;
  PngOutput output{&encoded, {}};
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, &output, onPngError, onPngWarning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  bool written = false;
  if (info) {
    png_set_write_fn(png, &output, appendPngBytes, nullptr);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    char key[] = "exposure";
    png_text text{};
    text.compression = PNG_TEXT_COMPRESSION_NONE;
    text.key = key, text.text = exposure.data(), text.text_length = exposure.size();
    written = writePngImage(png, info, width, height, channels, bytes.data(),
                            exposure.empty() ? nullptr : &text);
  }
  png_destroy_write_struct(&png, &info);
  if (!written) throwRun("cannot encode a PNG: {}", output.error);
  return encoded;
}

}  // namespace chromeball
