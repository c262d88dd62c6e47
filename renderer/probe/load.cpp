// SPDX-License-Identifier: Apache-2.0
#include "probe/load.h"

#include <fmt/format.h>

#include <algorithm>

#include "image/io/read.h"
#include "probe/convert.h"
#include "probe/detect_mapping.h"

namespace chromeball {
namespace {

// What OpenEXR's attribute `envmap` says, which OpenImageIO calls so.
std::optional<Mapping> statedMapping(const ImageFile& file) {
  const auto found = file.metadata.find("textureformat");
  const auto* format =
      found == file.metadata.end() ? nullptr : std::get_if<std::string>(&found->second);
  if (!format) return std::nullopt;
  if (*format == "LatLong Environment") return Mapping::LatLong;
  const bool isStrip = file.image.height == 6 * file.image.width;
  if (*format == "CubeFace Environment" && isStrip) return Mapping::VerticalStrip;
  return std::nullopt;
}

// Turned by half a circle: without resampling where the width is even.
Image turned(Image latLong) {
  if (latLong.width % 2)
    return convert(latLong, Mapping::LatLong, Mapping::LatLong, {latLong.width, latLong.height},
                   180);
  for (int y = 0; y < latLong.height; ++y)
    std::swap_ranges(latLong.at(0, y), latLong.at(latLong.width / 2, y),
                     latLong.at(latLong.width / 2, y));
  return latLong;
}

// Finds the greatest channel and how many texels have it.
void measureMaximum(const Image& image, LoadedProbe& probe) {
  size_t count = 0, alike = 0;
  const Rgb first = image.rgb(0, 0);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgb texel = image.rgb(x, y);
      const float greatest = maxComponent(texel);
      if (greatest > probe.maximum) probe.maximum = greatest, count = 0;
      count += greatest == probe.maximum;
      alike += texel == first;
    }
  const size_t all = size_t(image.width) * image.height;
  if (alike < all) probe.fractionAtMaximum = double(count) / double(all);
}

}  // namespace

LoadedProbe loadProbe(const std::filesystem::path& path, std::string_view mapping,
                      std::string_view mappingLocation) {
  ImageFile file = readImageFile(path);
  const std::optional<Mapping> stated = statedMapping(file);
  LoadedProbe probe;
  probe.isScreenImage = file.integers;
  Image image = colorOf(std::move(file), path);
  probe.fileWidth = image.width;
  probe.fileHeight = image.height;
  if (const auto given = parseMapping(mapping, image.width, image.height, mappingLocation)) {
    probe.mapping = *given;
  } else if (stated) {
    probe.mapping = *stated;
    probe.guessed = true;
    probe.reason = "its attribute `envmap` says so";
  } else {
    MappingGuess guess = guessMapping(image);
    probe.mapping = guess.mapping;
    probe.guessed = true;
    probe.certain = guess.certain;
    probe.reason = std::move(guess.reason);
  }

  const bool isLatLong = probe.mapping == Mapping::LatLong;
  probe.repair = repair(image, isLatLong);
  probe.turned = isLatLong && stated == Mapping::LatLong;
  measureMaximum(image, probe);
  if (probe.turned) image = turned(std::move(image));
  if (isLatLong) {
    probe.latLong = std::move(image);
  } else {
    const ImageSize size = latLongSize(probe.mapping, {image.width, image.height});
    probe.latLong = convert(image, probe.mapping, Mapping::LatLong, size);
  }
  return probe;
}

std::vector<std::string> warnings(const LoadedProbe& probe, const std::filesystem::path& path) {
  std::vector<std::string> lines;
  if (!probe.certain)
    lines.push_back(
        fmt::format("{}: taken for a {} map of {} x {}, because {}; give the mapping if "
                    "it is another",
                    path.string(), mappingName(probe.mapping), probe.fileWidth, probe.fileHeight,
                    probe.reason));
  if (probe.turned)
    lines.push_back(
        fmt::format("{}: turned by 180 degrees, since its attribute `envmap` says that "
                    "the centre looks along +Z",
                    path.string()));
  if (!probe.guessed && probe.mapping == Mapping::LatLong && probe.fileWidth == probe.fileHeight)
    lines.push_back(fmt::format(
        "{}: is square, and read as a lat-long map, which is twice as wide as high; is it "
        "an angular map or a mirror ball?",
        path.string()));
  if (probe.repair.total() > 0)
    lines.push_back(fmt::format("{}: repaired {}", path.string(), describe(probe.repair)));
  for (std::string& line : lightWarnings(probe, path)) lines.push_back(std::move(line));
  return lines;
}

std::vector<std::string> lightWarnings(const LoadedProbe& probe,
                                       const std::filesystem::path& path) {
  // Shares of the texels. An even map, but for a few texels, is not a picture that was cut off.
  constexpr double kMinPlateau = 1e-3, kMaxPlateau = 0.9;
  constexpr float kGreatestHalf = 65504;
  if (probe.maximum == 0) return {fmt::format("{}: is black: it lights nothing", path.string())};
  if (probe.isScreenImage)
    return {
        fmt::format("{}: holds integers, so light brighter than 1 was cut off when it was made; "
                    "an .exr or .hdr keeps it",
                    path.string())};
  const bool atLimit = probe.maximum == 1 || probe.maximum == kGreatestHalf;
  if (atLimit && probe.fractionAtMaximum >= kMinPlateau && probe.fractionAtMaximum <= kMaxPlateau)
    return {
        fmt::format("{}: {:.2g}% of its texels have the greatest value, {}: what was brighter "
                    "was cut off",
                    path.string(), 100 * probe.fractionAtMaximum, probe.maximum)};
  return {};
}

}  // namespace chromeball
