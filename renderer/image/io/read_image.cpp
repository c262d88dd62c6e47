// SPDX-License-Identifier: Apache-2.0
#include "image/io/read_image.h"

#include <algorithm>
#include <array>
#include <fstream>

#include "base/file.h"
#include "image/io/exr_header.h"
#include "image/io/oiio_file.h"
#include "image/io/oiio_reader.h"
#include "image/io/pfm.h"
#include "image/io/radiance_hdr.h"
#include "image/size_limits.h"
#include "image/tonemap.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

std::string firstBytes(const fs::path& path) {
  checkReadable(path);
  std::string bytes(4, '\0');
  std::ifstream(path, std::ios::binary).read(bytes.data(), std::streamsize(bytes.size()));
  return bytes;
}

// Of an .exr whose data window lies within its display window and is not all of it.
std::optional<Placement> placementOf(const OIIO::ImageSpec& spec) {
  const Placement p{spec.x - spec.full_x, spec.y - spec.full_y, spec.full_width, spec.full_height};
  const bool isWithin =
      p.x >= 0 && p.y >= 0 && p.width - p.x >= spec.width && p.height - p.y >= spec.height;
  if (!isWithin || (p.width == spec.width && p.height == spec.height)) return {};
  return p;
}

// Multiplies the colour by alpha; the texels are linear.
void associate(Image& image, int alphaChannel) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      float* texel = image.at(x, y);
      for (int c = 0; c < image.channels; ++c)
        if (c != alphaChannel) texel[c] *= texel[alphaChannel];
    }
}

ImageFile readTexels(const fs::path& path, OIIO::ImageInput& input, IntegerTexels integers) {
  const OIIO::ImageSpec& spec = input.spec();
  if (spec.deep || spec.depth > 1)
    throwUnreadable(path, "deep and volume images are not supported");
  ImageFile file;
  file.channels = spec.channelnames;
  file.metadata = metadataOf(spec);
  if (input.format_name() == std::string_view("openexr")) file.placement = placementOf(spec);
  file.integers = !spec.format.is_floating_point();
  file.bits = file.integers ? int(8 * spec.format.basesize()) : 0;
  file.image = Image(spec.width, spec.height, spec.nchannels);
  if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, file.image.texels.data()))
    throwUnreadable(path, input.geterror());

  if (file.integers && integers == IntegerTexels::Srgb)
    for (size_t i = 0; i < file.image.texels.size(); ++i)
      if (int(i % spec.nchannels) != spec.alpha_channel)
        file.image.texels[i] = srgbToLinear(file.image.texels[i]);
  if (spec.alpha_channel >= 0 && spec.get_int_attribute("oiio:UnassociatedAlpha"))
    associate(file.image, spec.alpha_channel);
  return file;
}

ImageFile readByLibrary(const fs::path& path, const char* reader, IntegerTexels integers) {
  const auto checkSize = [&](int width, int height, int channels) {
    checkImageSize(path, width, height, channels);
  };
  if (reader != std::string_view("openexr")) {
    // readTexels() associates alpha; the library would do so before the texels are decoded.
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    MemoryInput memory(reader, readFile(path), path.string(), checkSize, config);
    checkFileLength(path, reader, memory.input().spec());
    return readTexels(path, memory.input(), integers);
  }
  checkExrHeaders(path);
  const auto input = openImage(reader, path.string());
  const OIIO::ImageSpec& spec = input->spec();
  checkSize(spec.width, spec.height, spec.nchannels);
  checkFileLength(path, reader, spec);
  return readTexels(path, *input, integers);
}

Image extract(const ImageFile& file, const std::vector<size_t>& channels) {
  Image out(file.image.width, file.image.height, int(channels.size()));
  const size_t stride = file.image.channels, texelCount = size_t(out.width) * out.height;
  for (size_t i = 0; i < texelCount; ++i)
    for (size_t c = 0; c < channels.size(); ++c)
      out.texels[i * channels.size() + c] = file.image.texels[i * stride + channels[c]];
  return out;
}

std::optional<Image> findChannels(const ImageFile& file, const std::string& prefix,
                                  std::initializer_list<const char*> names) {
  std::vector<size_t> indices;
  for (const char* name : names) {
    const auto found = std::find(file.channels.begin(), file.channels.end(), prefix + name);
    if (found == file.channels.end()) return std::nullopt;
    indices.push_back(found - file.channels.begin());
  }
  return extract(file, indices);
}

}  // namespace

Metadata readExrMetadata(const fs::path& path) {
  checkReadable(path);
  checkExrHeaders(path);
  const auto input = OIIO::ImageInput::open(path.string());
  if (!input) throwUnreadable(path, OIIO::geterror());
  return metadataOf(input->spec());
}

ImageFile readImageFile(const fs::path& path, IntegerTexels integers) {
  const std::string magic = firstBytes(path);
  if (magic.starts_with("#?")) {
    HdrComments comments;
    Image image = readRadianceHdr(path, &comments);
    return {std::move(image), {"R", "G", "B"}, Metadata(comments.begin(), comments.end())};
  }
  if (magic.starts_with("PF")) return {readPfm(path), {"R", "G", "B"}, {}};
  if (magic.starts_with("Pf")) return {readPfm(path), {"Y"}, {}};
  const char* reader = readerFor({reinterpret_cast<const uint8_t*>(magic.data()), magic.size()});
  if (!reader) throwUnreadable(path, "it is not an EXR, Radiance HDR, PFM, PNG, JPEG or TIFF file");
  return readByOiio(path, [&] { return readByLibrary(path, reader, integers); });
}

std::optional<Image> findColor(const ImageFile& file) {
  if (auto color = findChannels(file, "", {"R", "G", "B"})) return color;
  for (const std::string& layer : layerNames(file))
    if (auto color = findChannels(file, layer + ".", {"R", "G", "B"})) return color;
  if (auto color = findChannels(file, "", {"Y", "Y", "Y"})) return color;
  if (file.channels.size() > 2) return std::nullopt;
  return extract(file, {0, 0, 0});
}

std::optional<Image> findColorAndAlpha(const ImageFile& file) {
  if (auto color = findChannels(file, "", {"R", "G", "B", "A"})) return color;
  return findColor(file);
}

std::optional<Image> findLayer(const ImageFile& file, const std::string& name) {
  const std::string prefix = name + ".";
  for (const std::array letters : {std::array{"R", "G", "B"}, std::array{"X", "Y", "Z"}})
    if (auto image = findChannels(file, prefix, {letters[0], letters[1], letters[2]})) return image;
  if (auto image = findChannels(file, name, {""})) return image;
  const auto belongs = [&](const std::string& channel) { return channel.starts_with(prefix); };
  const auto first = std::find_if(file.channels.begin(), file.channels.end(), belongs);
  if (first != file.channels.end()) return extract(file, {size_t(first - file.channels.begin())});
  return name == "alpha" ? findChannels(file, "A", {""}) : std::nullopt;
}

std::vector<std::string> layerNames(const ImageFile& file) {
  constexpr std::array kColorChannels = {"R", "G", "B", "A", "X", "Y", "Z"};
  std::vector<std::string> names;
  for (const std::string& channel : file.channels) {
    if (std::find(kColorChannels.begin(), kColorChannels.end(), channel) != kColorChannels.end())
      continue;
    const std::string name = channel.substr(0, channel.rfind('.'));
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

Image colorOf(ImageFile&& file, const fs::path& path) {
  if (file.channels == std::vector<std::string>{"R", "G", "B"}) return std::move(file.image);
  std::optional<Image> color = findColor(file);
  if (!color)
    throwInput("{}: has no colour; it needs channels R, G and B, or Y, or a single channel",
               path.string());
  return *std::move(color);
}

Image readImage(const fs::path& path, IntegerTexels integers) {
  return colorOf(readImageFile(path, integers), path);
}

}  // namespace chromeball
