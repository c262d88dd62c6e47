// SPDX-License-Identifier: Apache-2.0
#include "image/io/write_image.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "base/error.h"
#include "base/file.h"
#include "base/parallel.h"
#include "image/io/encode_png.h"
#include "image/io/lost_light.h"
#include "image/io/pfm.h"
#include "image/io/radiance_hdr.h"
#include "image/io/write_exr.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

std::string extension(const fs::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

// Colour in a PNG is unassociated; black where alpha is 0. This comes before the tone curve, which
// is not linear.
Rgb unassociated(const Rgb& color, float alpha) { return alpha > 0 ? color / alpha : Rgb(0); }

std::vector<uint8_t> encodeColor(const Image& color, const DisplayTransform& transform) {
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
  return encodePng(color.width, color.height, hasAlpha ? 4 : 3, bytes);
}

// Repeats grey in three channels.
Image repeated(const Image& grey) {
  Image color(grey.width, grey.height, 3);
  for (int y = 0; y < grey.height; ++y)
    for (int x = 0; x < grey.width; ++x) color.setRgb(x, y, Rgb(*grey.at(x, y)));
  return color;
}

// The formats that hold the colour alone.
Messages writeColor(const fs::path& path, const Image& color, const DisplayTransform& transform) {
  if (color.channels < 3) return writeColor(path, repeated(color), transform);
  const std::string kind = extension(path);
  if (kind == ".hdr")
    writeRadianceHdr(path, color);
  else if (kind == ".pfm")
    writePfm(path, color);
  else
    writeFile(path, encodeColor(color, transform));
  return lostLight(path, color);
}

}  // namespace

std::vector<uint8_t> encodePng(const Image& color, const DisplayTransform& transform) {
  if (color.channels < 3) return encodeColor(repeated(color), transform);
  return encodeColor(color, transform);
}

void checkImageName(const fs::path& path) {
  constexpr std::array kExtensions = {".exr", ".hdr", ".pfm", ".png"};
  if (std::find(kExtensions.begin(), kExtensions.end(), extension(path)) == kExtensions.end())
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
  if (extension(path) != ".exr") return writeColor(path, output.layers.front().image, transform);
  writeExr(path, output);
  return {};
}

Messages writeInWindow(const fs::path& path, OutputImage output, const fs::path& source,
                       const DisplayTransform& transform) {
  if (output.placement && extension(path) != ".exr") {
    Image& color = output.layers.front().image;
    color = inDisplayWindow(std::move(color), output.placement, source);
  }
  return writeImage(path, output, transform);
}

Messages writeImage(const fs::path& path, const Image& color, const DisplayTransform& transform) {
  checkWritable(path);
  if (extension(path) != ".exr") return writeColor(path, color, transform);
  const char* letters = color.channels >= 4 ? "RGBA" : color.channels == 3 ? "RGB" : "Y";
  writeExr(path, OutputImage{{{"", letters, color}}, {}, {}, {}});
  return {};
}

}  // namespace chromeball
