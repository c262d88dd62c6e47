// SPDX-License-Identifier: Apache-2.0
#include "image/io/encode_png.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "base/error.h"

namespace chromeball {

std::vector<uint8_t> encodePng(int width, int height, int channels,
                               std::span<const uint8_t> bytes) {
  OIIO::Filesystem::IOVecOutput encoded;
  const auto output = OIIO::ImageOutput::create("png");
  OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  // Without this attribute OpenImageIO would divide the colour by alpha.
  if (channels == 4) spec.attribute("oiio:UnassociatedAlpha", 1);
  if (!output || !output->set_ioproxy(&encoded) || !output->open("memory.png", spec) ||
      !output->write_image(OIIO::TypeDesc::UINT8, bytes.data()) || !output->close())
    throwRun("cannot encode a PNG: {}", output ? output->geterror() : OIIO::geterror());
  return encoded.buffer();
}

}  // namespace chromeball
