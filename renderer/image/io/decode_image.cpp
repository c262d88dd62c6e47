// SPDX-License-Identifier: Apache-2.0
#include "image/io/decode_image.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "base/error.h"
#include "image/io/decode_webp.h"
#include "image/io/oiio_reader.h"
#include "image/io/silenced_stderr.h"
#include "image/io/strip_metadata.h"
#include "image/size_limits.h"

namespace chromeball {
namespace {

using OIIO::ImageInput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

bool startsWith(std::span<const uint8_t> file, std::string_view magic, size_t at = 0) {
  return file.size() >= at + magic.size() &&
         std::equal(magic.begin(), magic.end(), file.begin() + at,
                    [](char a, uint8_t b) { return uint8_t(a) == b; });
}

bool isWebp(std::span<const uint8_t> file) {
  return startsWith(file, "RIFF") && startsWith(file, "WEBP", 8);
}

std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

// Decides by the content, since many models label their images wrongly.
const char* readerOf(std::span<const uint8_t> file, const std::string& name) {
  const char* reader = readerFor(file);
  if (reader && (reader == std::string_view("png") || reader == std::string_view("jpeg")))
    return reader;
  const char* found = startsWith(file, "\xabKTX 20")                ? "KTX2"
                      : startsWith(file, "DDS ")                    ? "DDS"
                      : startsWith(file, "version https://git-lfs") ? "a Git LFS pointer"
                                                                    : nullptr;
  if (found) throwInput("{}: is {}; it must be PNG, JPEG or WebP", name, found);
  throwInput("{}: is not a PNG, JPEG or WebP file", name);
}

// stripJpeg() checks whether the bytes of a JPEG can hold as many texels.
void checkSize(int width, int height, int channels, const char* reader, size_t fileBytes,
               const std::string& name) {
  if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide || channels < 1)
    throwInput("{}: {} x {} texels with {} channels; the limit is {} x {}", name, width, height,
               channels, kMaxImageSide, kMaxImageSide);
  // A texel of a PNG takes at least one bit.
  if (reader == std::string_view("png") &&
      uint64_t(width) * uint64_t(height) > fileBytes * 8 * kMaxDeflateRatio)
    throwInput("{}: damaged image: {} x {} texels cannot fit into {} bytes", name, width, height,
               fileBytes);
}

// Reads the image as RGBA texels of type T. It reads a few rows at a time, so that each page of the
// result is touched once and no other buffer is large: page faults cost about as much as decoding.
// `type` is the type to convert to. It is UNKNOWN if the file holds T, because OpenImageIO
// allocates a buffer of 64 MB on every call that requests T itself.
template <class T, class Texel>
std::vector<Texel> readTexels(ImageInput& input, TypeDesc type, T opaque, const std::string& name) {
  constexpr int kRows = 32;
  const ImageSpec& spec = input.spec();
  const int channels = std::min(spec.nchannels, 4);
  std::vector<T> rows(size_t(spec.width) * kRows * size_t(channels));
  std::vector<Texel> wide(size_t(spec.width) * kRows), texels;
  texels.reserve(size_t(spec.width) * size_t(spec.height));
  for (int y = 0; y < spec.height; y += kRows) {
    const int end = std::min(y + kRows, spec.height);
    if (!input.read_scanlines(0, 0, spec.y + y, spec.y + end, 0, 0, channels, type, rows.data()))
      throwInput("{}: damaged image: {}", name, firstLine(input.geterror()));
    const size_t count = size_t(end - y) * size_t(spec.width);
    const T* from = rows.data();
    for (size_t i = 0; i < count; ++i, from += channels) {
      if (channels >= 3)
        wide[i] = {from[0], from[1], from[2], channels == 4 ? from[3] : opaque};
      else
        wide[i] = {from[0], from[0], from[0], channels == 2 ? from[1] : opaque};
    }
    texels.insert(texels.end(), wide.begin(), wide.begin() + std::ptrdiff_t(count));
  }
  return texels;
}

}  // namespace

uint64_t decodedBytes(std::span<const uint8_t> file) {
  const auto bytes = [&](const HeaderSize& size, uint64_t perTexel, uint64_t texelsPerByte) {
    const uint64_t texels = uint64_t(size.width) * uint64_t(size.height);
    const bool isPossible = size.width <= kMaxImageSide && size.height <= kMaxImageSide &&
                            texels <= file.size() * texelsPerByte;
    return isPossible ? texels * perTexel : 0;
  };
  if (isWebp(file)) return bytes(webpSize(file), 4, 1 << 15);
  const char* reader = readerFor(file);
  if (reader && reader == std::string_view("jpeg"))
    return bytes(jpegSize(file), 4, kMaxTexelsPerJpegByte);
  constexpr size_t kDepthAt = 24;
  if (reader && reader == std::string_view("png") && file.size() > kDepthAt)
    return bytes(pngSize(file), file[kDepthAt] > 8 ? sizeof(vec4) : 4, 8 * kMaxDeflateRatio);
  return 0;
}

DecodedImage decodeImage(std::span<const uint8_t> file, const std::string& name) {
  if (isWebp(file)) return decodeWebp(file, name);
  const char* reader = readerOf(file, name);
  const SilencedStderr silenced;
  ImageSpec config;
  config["oiio:UnassociatedAlpha"] = 1;
  const auto check = [&](int width, int height, int channels) {
    checkSize(width, height, channels, reader, file.size(), name);
  };
  std::optional<MemoryInput> memory;
  try {
    memory.emplace(reader, file, name, check, config);
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throwInput("{}: damaged image: {}", name, firstLine(error.what()));
  }
  ImageInput& input = memory->input();

  DecodedImage image;
  image.width = input.spec().width;
  image.height = input.spec().height;
  if (input.spec().format == TypeDesc::UINT8)
    image.texels8 =
        readTexels<uint8_t, std::array<uint8_t, 4>>(input, TypeDesc::UNKNOWN, 255, name);
  else
    image.texelsFloat = readTexels<float, vec4>(input, TypeDesc::FLOAT, 1.0f, name);
  return image;
}

}  // namespace chromeball
