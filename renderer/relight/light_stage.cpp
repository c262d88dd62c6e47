// SPDX-License-Identifier: Apache-2.0
#include "relight/light_stage.h"

#include <cmath>
#include <unordered_map>

#include "base/error.h"
#include "image/io/write_exr.h"
#include "image/size_limits.h"

namespace chromeball {
namespace {

constexpr const char* kBasisName = "basis";  // the attribute
constexpr const char* kOwn = "own";
constexpr int kOtherChannels = 6;  // colour, and the scene's own light

std::string layerName(int element) { return fmt::format("element.{:04}", element); }

void addChannels(std::vector<std::string>& names, const std::string& layer) {
  for (const char* letter : {".R", ".G", ".B"}) names.push_back(layer + letter);
}

std::vector<std::string> channelNames(const DirectionBasis& basis) {
  std::vector<std::string> names;
  for (int i = 0; i < basis.size(); ++i) addChannels(names, layerName(i));
  return names;
}

DirectionBasis basisOf(const std::filesystem::path& path, const Metadata& metadata) {
  const auto found = metadata.find(kBasisName);
  const auto* name = found == metadata.end() ? nullptr : std::get_if<std::string>(&found->second);
  if (!name) throwInput("{}: is not a light stage; `chromeball basis` writes one", path.string());
  return {*name, path.string()};
}

// The channels with these names; nullopt if one is missing.
std::optional<std::vector<size_t>> positions(const ImageFile& file,
                                             const std::vector<std::string>& names) {
  std::unordered_map<std::string, size_t> byName;
  for (size_t i = 0; i < file.channels.size(); ++i) byName[file.channels[i]] = i;
  std::vector<size_t> found;
  for (const std::string& name : names) {
    const auto at = byName.find(name);
    if (at == byName.end()) return std::nullopt;
    found.push_back(at->second);
  }
  return found;
}

Image extract(const Image& all, const std::vector<size_t>& channels) {
  Image part(all.width, all.height, int(channels.size()));
  for (int y = 0; y < all.height; ++y)
    for (int x = 0; x < all.width; ++x)
      for (size_t c = 0; c < channels.size(); ++c) part.at(x, y)[c] = all.at(x, y)[channels[c]];
  return part;
}

// The same in place: a pixel's channels move to the front, so that the image never exists twice.
Image extract(Image&& all, const std::vector<size_t>& channels) {
  std::vector<float> pixel(channels.size());
  const size_t pixels = size_t(all.width) * size_t(all.height), stride = size_t(all.channels);
  for (size_t i = 0; i < pixels; ++i) {
    for (size_t c = 0; c < pixel.size(); ++c) pixel[c] = all.texels[i * stride + channels[c]];
    std::copy(pixel.begin(), pixel.end(), all.texels.begin() + ptrdiff_t(i * pixel.size()));
  }
  all.channels = int(channels.size());
  all.texels.resize(pixels * channels.size());
  return std::move(all);
}

void checkFinite(const std::filesystem::path& path, const Image& image) {
  for (size_t i = 0; i < image.texels.size(); ++i)
    if (!std::isfinite(image.texels[i])) {
      const size_t pixel = i / size_t(image.channels);
      throwInput("{}: pixel {}, {} has values that are not finite", path.string(),
                 pixel % size_t(image.width), pixel / size_t(image.width));
    }
}

}  // namespace

void checkStageSize(const DirectionBasis& basis, int width, int height, std::string_view location) {
  const uint64_t numbers =
      uint64_t(width) * uint64_t(height) * uint64_t(3 * basis.size() + kOtherChannels);
  if (numbers > kMaxImageFloats)
    throwInput(
        "{}: {} x {} pixels with {} elements are {} numbers; the limit is {}: take a smaller "
        "--size or fewer --directions",
        location, width, height, basis.size(), numbers, kMaxImageFloats);
}

void writeStage(const std::filesystem::path& path, const LightStage& stage, const Image& color,
                Metadata metadata, bool halves) {
  metadata[kBasisName] = stage.basis.name();
  std::vector<ChannelBlock> blocks{{{"R", "G", "B"}, &color},
                                   {channelNames(stage.basis), &stage.elements}};
  if (!stage.own.empty()) {
    blocks.push_back({{}, &stage.own});
    addChannels(blocks.back().names, kOwn);
  }
  writeExr(path, blocks, metadata, halves);
}

LightStage readStage(const std::filesystem::path& path) {
  ImageFile file = readImageFile(path);
  LightStage stage{basisOf(path, file.metadata), {}, {}};
  const auto elements = positions(file, channelNames(stage.basis));
  if (!elements)
    throwInput("{}: lacks elements of its basis {}, which has {}", path.string(),
               stage.basis.name(), stage.basis.size());
  std::vector<std::string> ownNames;
  addChannels(ownNames, kOwn);
  if (const auto own = positions(file, ownNames)) stage.own = extract(file.image, *own);
  stage.elements = extract(std::move(file.image), *elements);
  checkFinite(path, stage.elements);
  checkFinite(path, stage.own);
  return stage;
}

}  // namespace chromeball
