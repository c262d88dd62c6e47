// SPDX-License-Identifier: Apache-2.0
// The colour and the layers of a file that was read.
#include <algorithm>
#include <array>
#include <set>

#include "base/error.h"
#include "image/io/color_channels.h"
#include "image/io/read_image.h"
#include "image/size_limits.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

Image extract(const ImageFile& file, const std::vector<size_t>& channels) {
  Image out(file.image.width, file.image.height, int(channels.size()));
  for (size_t i = 0; i < out.pixels(); ++i)
    for (size_t c = 0; c < channels.size(); ++c) out.at(i)[c] = file.image.at(i)[channels[c]];
  return out;
}

// The primaries of the file's colour, in three channels or more. nullopt: Rec. 709's, or grey,
// which has none.
std::optional<Chromaticities> primariesOf(const std::vector<size_t>& channels,
                                          const ImageFile& file) {
  const bool isGrey = channels[0] == channels[1];
  if (isGrey || !file.primaries || isRec709(*file.primaries)) return {};
  return file.primaries;
}

Image inRec709(Image color, const std::vector<size_t>& channels, const ImageFile& file) {
  if (const auto primaries = primariesOf(channels, file))
    convertColor(color, toRec709(*primaries).value());  // checked by readImageFile()
  return color;
}

// "A, Z and 3 more"; names in a damaged file may hold any bytes.
std::string listOf(const std::vector<std::string>& channels) {
  constexpr size_t kMost = 8, kMostLetters = 40;
  std::string text;
  for (size_t i = 0; i < std::min(channels.size(), kMost); ++i)
    text += (i ? ", " : "") + channels[i].substr(0, kMostLetters);
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return channels.size() > kMost ? fmt::format("{} and {} more", text, channels.size() - kMost)
                                 : text;
}

using ChannelIndices = std::vector<size_t>;

std::optional<ChannelIndices> indicesOf(const ImageFile& file, const std::string& prefix,
                                        std::initializer_list<const char*> names) {
  ChannelIndices indices;
  for (const char* name : names) {
    const auto found = std::find(file.channels.begin(), file.channels.end(), prefix + name);
    if (found == file.channels.end()) return std::nullopt;
    indices.push_back(size_t(found - file.channels.begin()));
  }
  return indices;
}

std::optional<Image> findChannels(const ImageFile& file, const std::string& prefix,
                                  std::initializer_list<const char*> names) {
  if (const auto indices = indicesOf(file, prefix, names)) return extract(file, *indices);
  return std::nullopt;
}

// The same as extract(), for a file whose image is no longer needed: in place if the result is not
// larger.
Image taken(ImageFile& file, const ChannelIndices& channels) {
  const size_t stride = size_t(file.image.channels), count = channels.size();
  if (count > stride) return extract(file, channels);
  Image image = std::move(file.image);
  bool isWhole = count == stride;
  for (size_t c = 0; c < count; ++c) isWhole = isWhole && channels[c] == c;
  if (isWhole) return image;
  const size_t texelCount = image.texels.size() / stride;
  std::vector<float> texel(count);
  float* to = image.texels.data();
  for (const float* from = to; from != image.texels.data() + texelCount * stride; from += stride) {
    for (size_t c = 0; c < count; ++c) texel[c] = from[channels[c]];
    to = std::copy(texel.begin(), texel.end(), to);
  }
  image.channels = int(count);
  image.texels.resize(texelCount * count);
  return image;
}

std::optional<ChannelIndices> colorIndices(const ImageFile& file) {
  const PartChannels part{file.part, file.channels};
  const std::optional<ColorChannels> found = findColorChannels({&part, 1});
  if (!found) return {};
  const std::vector<std::string>& names = found->channels;
  if (names.size() == 1) return indicesOf(file, names[0], {"", "", ""});
  return indicesOf(file, "", {names[0].c_str(), names[1].c_str(), names[2].c_str()});
}

ChannelIndices neededColor(const ImageFile& file, const fs::path& path) {
  const auto indices = colorIndices(file);
  if (!indices)
    throwInput(
        "{}: has no colour; it needs channels R, G and B, or Y, or a single channel of light; it "
        "has {}",
        path.string(), listOf(file.channels));
  return *indices;
}

}  // namespace

const char* decodingInWords(const ImageFile& file) {
  if (!file.transfer || file.transfer == Transfer::Srgb) return "decoded from sRGB";
  return file.transfer == Transfer::Linear ? "linear, as it states" : "decoded as it states";
}

Messages clippedLight(const ImageFile& file, const fs::path& path) {
  Messages messages;
  if (file.integers)
    addWarning(messages,
               "{}: has integer texels: {}, without the response of the camera, and clipped at "
               "white; use an HDR image",
               path.string(), decodingInWords(file));
  const std::optional<Image> clipped = findLayer(file, "clipped");
  const auto isMarked = [](float mark) { return mark > 0; };
  if (const auto marked = clipped ? std::ranges::count_if(clipped->texels, isMarked) : 0)
    addWarning(messages,
               "{}: {:.2g}% of its pixels are brighter than what was measured (layer `clipped`); "
               "exposures that are compared there are wrong",
               path.string(), 100 * double(marked) / double(clipped->pixels()));
  return messages;
}

std::optional<Image> findColor(const ImageFile& file) {
  const auto indices = colorIndices(file);
  if (!indices) return {};
  return inRec709(extract(file, *indices), *indices, file);
}

std::optional<Image> findColorAndAlpha(const ImageFile& file) {
  if (const auto indices = indicesOf(file, "", {"R", "G", "B", "A"}))
    return inRec709(extract(file, *indices), *indices, file);
  return findColor(file);
}

std::optional<Image> findLayer(const ImageFile& file, const std::string& name) {
  const std::string prefix = name + ".";
  if (const auto indices = indicesOf(file, prefix, {"R", "G", "B"})) {
    Image image = extract(file, *indices);
    return isColorLayer(name) ? inRec709(std::move(image), *indices, file) : std::move(image);
  }
  if (auto image = findChannels(file, prefix, {"X", "Y", "Z"})) return image;
  if (auto image = findChannels(file, name, {""})) return image;
  const auto belongs = [&](const std::string& channel) { return channel.starts_with(prefix); };
  const auto first = std::find_if(file.channels.begin(), file.channels.end(), belongs);
  if (first != file.channels.end()) return extract(file, {size_t(first - file.channels.begin())});
  return name == "alpha" ? findChannels(file, "A", {""}) : std::nullopt;
}

std::vector<std::string> layerNames(const ImageFile& file) {
  constexpr std::array kColorChannels = {"R", "G", "B", "A", "X", "Y", "Z"};
  std::vector<std::string> names;
  std::set<std::string> found;
  for (const std::string& channel : file.channels) {
    if (std::find(kColorChannels.begin(), kColorChannels.end(), channel) != kColorChannels.end())
      continue;
    const std::string name = channel.substr(0, channel.rfind('.'));
    if (found.insert(name).second) names.push_back(name);
  }
  return names;
}

Image inDisplayWindow(Image data, const std::optional<Placement>& placement, const fs::path& path) {
  if (!placement) return data;
  const Placement& p = *placement;
  checkImageSize(path, p.width, p.height, data.channels);
  checkImageMemory(path, p.width, p.height, data.channels);
  const int64_t left = std::max(p.x, 0), top = std::max(p.y, 0);
  const int64_t right = std::min<int64_t>(p.width, int64_t(p.x) + data.width),
                bottom = std::min<int64_t>(p.height, int64_t(p.y) + data.height);
  if (left >= right || top >= bottom)
    throwInput("{}: its data window lies outside of its display window", path.string());
  Image window(p.width, p.height, data.channels);
  for (int64_t y = top; y < bottom; ++y)
    std::copy_n(data.at(int(left - p.x), int(y - p.y)), size_t(right - left) * data.channels,
                window.at(int(left), int(y)));
  return window;
}

Image colorOfData(ImageFile&& file, const fs::path& path) {
  const ChannelIndices indices = neededColor(file, path);
  return inRec709(taken(file, indices), indices, file);
}

StoredColor storedColorOf(ImageFile&& file, const fs::path& path) {
  const ChannelIndices indices = neededColor(file, path);
  return {inDisplayWindow(taken(file, indices), file.placement, path), primariesOf(indices, file)};
}

Image colorAndAlphaOfData(ImageFile&& file, const fs::path& path) {
  const auto indices = indicesOf(file, "", {"R", "G", "B", "A"});
  if (!indices) return colorOfData(std::move(file), path);
  return inRec709(taken(file, *indices), *indices, file);
}

Image colorOf(ImageFile&& file, const fs::path& path) {
  const std::optional<Placement> placement = file.placement;
  return inDisplayWindow(colorOfData(std::move(file), path), placement, path);
}

Image maskOf(ImageFile&& file, const fs::path& path) {
  if (file.channels.size() > 1) return colorOf(std::move(file), path);
  return inDisplayWindow(extract(file, {0, 0, 0}), file.placement, path);
}

std::optional<Image> layerOf(const ImageFile& file, const std::string& name, const fs::path& path) {
  std::optional<Image> layer = findLayer(file, name);
  if (layer) layer = inDisplayWindow(*std::move(layer), file.placement, path);
  return layer;
}

Image colorAndAlphaOf(ImageFile&& file, const fs::path& path) {
  const std::optional<Placement> placement = file.placement;
  return inDisplayWindow(colorAndAlphaOfData(std::move(file), path), placement, path);
}

}  // namespace chromeball
