// SPDX-License-Identifier: Apache-2.0
#include "image/io/decode_image.h"

#include <webp/decode.h>

#include <algorithm>

#include "base/error.h"
#include "base/memory.h"
#include "image/io/image_format.h"
#include "image/size_limits.h"

namespace chromeball {
namespace {

[[noreturn]] void refuseFormat(std::span<const uint8_t> file, const std::string& name) {
  const std::string_view text = textOf(file);
  const char* found = text.starts_with("\xabKTX 20")                ? "KTX2"
                      : text.starts_with("DDS ")                    ? "DDS"
                      : text.starts_with("version https://git-lfs") ? "a Git LFS pointer"
                                                                    : nullptr;
  if (found) throwInput("{}: is {}; it must be PNG, JPEG or WebP", name, found);
  throwInput("{}: is not a PNG, JPEG or WebP file", name);
}

void checkTextureMemory(const SampleLayout& image, const std::string& name) {
  constexpr double kTextureCopies = 1.5;  // itself and its smaller levels
  checkImageMemory(name, image.width, image.height, 4, image.bits > 8 ? sizeof(float) : 1,
                   kTextureCopies);
}

// Decides by the content, since many models label their images wrongly.
std::unique_ptr<SampleReader> openTexture(std::span<const uint8_t> file, const std::string& name,
                                          const CheckSize& check) {
  const ImageFormat format = imageFormat(file);
  if (format != ImageFormat::Png && format != ImageFormat::Jpeg) refuseFormat(file, name);
  const auto checkAll = [&](const SampleLayout& image) {
    if (image.width > kMaxImageSide || image.height > kMaxImageSide)
      throwInput("{}: {} x {} texels with {} channels; the limit is {} x {}", name, image.width,
                 image.height, image.channels, kMaxImageSide, kMaxImageSide);
    // A texel of a PNG takes at least one bit.
    if (format == ImageFormat::Png &&
        uint64_t(image.width) * uint64_t(image.height) > file.size() * 8 * kMaxDeflateRatio)
      throwInput("{}: damaged image: {} x {} texels cannot fit into {} bytes", name, image.width,
                 image.height, file.size());
    if (check) check(image);
    checkTextureMemory(image, name);
  };
  return format == ImageFormat::Png ? openPng(file, checkAll) : openJpeg(file, checkAll);
}

// Widens rows of samples of type T, multiplied by `unit`, to RGBA texels. Takes a row at a time, so
// that each page of the result is touched once and no other buffer is large: page faults cost about
// as much as decoding.
template <class T, class Texel>
std::vector<Texel> readTexels(SampleReader& reader, typename Texel::value_type unit,
                              typename Texel::value_type opaque) {
  const auto [width, height, channels, bits] = reader.layout();
  std::vector<Texel> wide(static_cast<size_t>(width)), texels;
  reserveLong(texels, wide.size() * size_t(height));
  reader.read([&, channels = channels](int, const void* samples) {
    const T* from = static_cast<const T*>(samples);
    const auto at = [&](int channel) { return typename Texel::value_type(from[channel] * unit); };
    for (Texel& texel : wide) {
      if (channels >= 3)
        texel = {at(0), at(1), at(2), channels == 4 ? at(3) : opaque};
      else
        texel = {at(0), at(0), at(0), channels == 2 ? at(1) : opaque};
      from += channels;
    }
    texels.insert(texels.end(), wide.begin(), wide.end());
  });
  return texels;
}

// Of a still image; the format allows at most 16383 texels per side.
SampleLayout webpLayout(std::span<const uint8_t> file, const std::string& name) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(file.data(), file.size(), &features) != VP8_STATUS_OK)
    throwInput("{}: damaged image: not a WebP", name);
  if (features.has_animation) throwInput("{}: is an animation; it must be a still image", name);
  // An image of one colour compresses 25000 : 1. Small images may have any ratio.
  constexpr uint64_t kAlwaysAllowed = 1 << 24, kMaxRatio = 32768;
  const uint64_t texels = uint64_t(features.width) * uint64_t(features.height);
  if (texels > std::max(kAlwaysAllowed, file.size() * kMaxRatio))
    throwInput("{}: damaged image: {} x {} texels cannot fit into {} bytes", name, features.width,
               features.height, file.size());
  return {features.width, features.height, features.has_alpha ? 4 : 3};
}

DecodedImage decodeWebp(std::span<const uint8_t> file, const std::string& name,
                        const CheckSize& check) {
  const SampleLayout layout = webpLayout(file, name);
  if (check) check(layout);
  checkTextureMemory(layout, name);
  DecodedImage image{layout.width, layout.height, {}, {}};
  image.texels8.resize(size_t(image.width) * size_t(image.height));
  uint8_t* out = image.texels8.data()->data();
  if (!WebPDecodeRGBAInto(file.data(), file.size(), out, image.texels8.size() * 4, image.width * 4))
    throwInput("{}: damaged image", name);
  return image;
}

}  // namespace

uint64_t decodedBytes(std::span<const uint8_t> file) {
  try {
    const SampleLayout image = imageFormat(file) == ImageFormat::Webp
                                   ? webpLayout(file, "")
                                   : openTexture(file, "", {})->layout();
    return uint64_t(image.width) * uint64_t(image.height) * (image.bits > 8 ? sizeof(vec4) : 4);
  } catch (const std::runtime_error&) {
    return 0;
  }
}

DecodedImage decodeImage(std::span<const uint8_t> file, const std::string& name,
                         const CheckSize& check) {
  if (imageFormat(file) == ImageFormat::Webp) return decodeWebp(file, name, check);
  try {
    const std::unique_ptr<SampleReader> reader = openTexture(file, name, check);
    DecodedImage image;
    image.width = reader->layout().width;
    image.height = reader->layout().height;
    if (reader->layout().bits == 8)
      image.texels8 = readTexels<uint8_t, std::array<uint8_t, 4>>(*reader, 1, 255);
    else
      image.texelsFloat = readTexels<uint16_t, vec4>(*reader, 1.0f / 65535, 1.0f);
    return image;
  } catch (const InputError&) {
    throw;
  } catch (const Interrupted&) {
    throw;
  } catch (const std::runtime_error& error) {
    throwInput("{}: damaged image: {}", name, error.what());
  }
}

}  // namespace chromeball
