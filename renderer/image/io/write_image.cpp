// SPDX-License-Identifier: Apache-2.0
#include "image/io/write_image.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>

#include "base/error.h"
#include "base/file.h"
#include "image/io/encode_png.h"
#include "image/io/pfm.h"
#include "image/io/radiance_hdr.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

std::string extension(const fs::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

// `texels` holds channels of the spec's format, interleaved.
void writeByLibrary(const fs::path& path, const std::string& format, const OIIO::ImageSpec& spec,
                    const void* texels) {
  const auto check = [&](bool ok, const std::string& reason) {
    if (!ok)
      throwRun("{}: cannot be written: {}", path.string(),
               reason.empty() ? std::strerror(errno) : reason);
  };
  AtomicFile file(path);
  const auto output = OIIO::ImageOutput::create(format);
  check(output != nullptr, "this build of OpenImageIO does not support the format");
  check(output->open(file.temporary().string(), spec), output->geterror());
  check(output->write_image(spec.format, texels), output->geterror());
  check(output->close(), output->geterror());
  file.commit();
}

std::vector<std::string> channelNames(const OutputImage& output) {
  std::vector<std::string> names;
  for (const Layer& layer : output.layers) {
    if (layer.channels.empty()) names.push_back(layer.name);
    for (const char letter : layer.channels)
      names.push_back(layer.name.empty() ? std::string(1, letter) : layer.name + '.' + letter);
  }
  return names;
}

void writeExr(const fs::path& path, const OutputImage& output) {
  const Image& color = output.layers.front().image;
  const std::vector<std::string> names = channelNames(output);
  Image all(color.width, color.height, int(names.size()));
  int offset = 0;
  for (const Layer& layer : output.layers) {
    for (int y = 0; y < all.height; ++y)
      for (int x = 0; x < all.width; ++x)
        std::copy_n(layer.image.at(x, y), layer.image.channels, all.at(x, y) + offset);
    offset += layer.image.channels;
  }

  OIIO::ImageSpec spec(all.width, all.height, all.channels, OIIO::TypeDesc::FLOAT);
  spec.channelnames = names;
  spec.attribute("compression", "zip");
  for (const auto& [name, contents] : output.metadata)
    if (const auto* matrix = std::get_if<Matrix44>(&contents))
      spec.attribute(name, OIIO::TypeMatrix, matrix->data());
    else if (const auto* text = std::get_if<std::string>(&contents))
      spec.attribute(name, *text);
    else if (const auto* number = std::get_if<float>(&contents))
      spec.attribute(name, *number);
    else
      spec.attribute(name, std::get<int>(contents));
  writeByLibrary(path, "openexr", spec, all.texels.data());
}

// Colour in a PNG is unassociated; black where alpha is 0. This comes before the tone curve, which
// is not linear.
Rgb unassociated(const Rgb& color, float alpha) { return alpha > 0 ? color / alpha : Rgb(0); }

void writePng(const fs::path& path, const Image& color, const DisplayTransform& transform) {
  const auto byte = [](float encoded) { return uint8_t(std::lround(255 * encoded)); };
  const bool hasAlpha = color.channels == 4;
  std::vector<uint8_t> bytes;
  bytes.reserve(size_t(color.width) * color.height * (hasAlpha ? 4 : 3));
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x) {
      const float alpha = hasAlpha ? std::clamp(color.at(x, y)[3], 0.0f, 1.0f) : 1;
      const Rgb shown = display(transform, unassociated(color.rgb(x, y), alpha));
      for (int c = 0; c < 3; ++c) bytes.push_back(byte(linearToSrgb(shown[c])));
      if (hasAlpha) bytes.push_back(byte(alpha));
    }
  writeFile(path, encodePng(color.width, color.height, hasAlpha ? 4 : 3, bytes));
}

// Repeats grey in three channels; returns other images unchanged.
Image withColor(const Image& image) {
  if (image.channels >= 3) return image;
  Image color(image.width, image.height, 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) color.setRgb(x, y, Rgb(*image.at(x, y)));
  return color;
}

}  // namespace

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

void writeImage(const fs::path& path, const OutputImage& output,
                const DisplayTransform& transform) {
  checkWritable(path);
  const std::string kind = extension(path);
  if (kind == ".exr") return writeExr(path, output);
  const Image color = withColor(output.layers.front().image);
  if (kind == ".hdr") return writeRadianceHdr(path, color);
  if (kind == ".pfm") return writePfm(path, color);
  writePng(path, color, transform);
}

void writeImage(const fs::path& path, const Image& color, const DisplayTransform& transform) {
  const char* letters = color.channels >= 4 ? "RGBA" : color.channels == 3 ? "RGB" : "Y";
  writeImage(path, OutputImage{{{"", letters, color}}, {}}, transform);
}

}  // namespace chromeball
