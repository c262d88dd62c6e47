// SPDX-License-Identifier: Apache-2.0
#include "image/io/decode_webp.h"

#include <webp/decode.h>

#include "base/error.h"

namespace chromeball {
namespace {

// An image of one colour compresses 25000 : 1. Small images may have any ratio.
bool fitsInto(uint64_t texels, size_t fileBytes) {
  return texels <= (uint64_t(1) << 24) || texels <= fileBytes * 32768;
}

}  // namespace

DecodedImage decodeWebp(std::span<const uint8_t> file, const std::string& name) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(file.data(), file.size(), &features) != VP8_STATUS_OK)
    throwInput("{}: damaged image: not a WebP", name);
  if (features.has_animation) throwInput("{}: is an animation; it must be a still image", name);
  DecodedImage image;  // the format allows at most 16383 texels per side
  image.width = features.width;
  image.height = features.height;
  const uint64_t texels = uint64_t(image.width) * uint64_t(image.height);
  if (!fitsInto(texels, file.size()))
    throwInput("{}: damaged image: {} x {} texels cannot fit into {} bytes", name, image.width,
               image.height, file.size());
  image.texels8.resize(texels);
  uint8_t* out = image.texels8.data()->data();
  const size_t bytes = image.texels8.size() * 4;
  if (!WebPDecodeRGBAInto(file.data(), file.size(), out, bytes, image.width * 4))
    throwInput("{}: damaged image", name);
  return image;
}

uint64_t webpBytes(std::span<const uint8_t> file) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(file.data(), file.size(), &features) != VP8_STATUS_OK) return 0;
  const uint64_t texels = uint64_t(features.width) * uint64_t(features.height);
  return fitsInto(texels, file.size()) ? texels * 4 : 0;
}

}  // namespace chromeball
