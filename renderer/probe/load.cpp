// SPDX-License-Identifier: Apache-2.0
#include "probe/load.h"

#include <fmt/format.h>

#include <atomic>
#include <new>

#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"
#include "image/io/read_image.h"
#include "image/size_limits.h"
#include "probe/convert.h"
#include "probe/cube_faces.h"

namespace chromeball {
namespace {

const std::string* textOf(const Metadata& metadata, const char* attribute) {
  const auto found = metadata.find(attribute);
  return found == metadata.end() ? nullptr : std::get_if<std::string>(&found->second);
}

// The size of the whole map; the file's data window may be a part of it.
ImageSize sizeOf(const ImageFile& file) {
  if (file.placement) return {file.placement->width, file.placement->height};
  return {file.image.width, file.image.height};
}

// The mapping in OpenEXR's `envmap` attribute.
std::optional<Mapping> openExrMapping(const ImageFile& file) {
  const std::string* envmap = textOf(file.metadata, kEnvmapAttribute);
  if (!envmap) return std::nullopt;
  if (*envmap == kEnvmapLatLong) return Mapping::LatLong;
  const ImageSize size = sizeOf(file);
  const bool isStrip = size.height == 6 * int64_t(size.width);
  if (*envmap == kEnvmapCube && isStrip) return Mapping::VerticalStrip;
  return std::nullopt;
}

// The map turned by 180 degrees; without resampling if the width is even.
Image turned(Image latLong) {
  if (latLong.width % 2)
    return convert(latLong, Mapping::LatLong, Mapping::LatLong, {latLong.width, latLong.height},
                   180);
  for (int y = 0; y < latLong.height; ++y)
    std::swap_ranges(latLong.at(0, y), latLong.at(latLong.width / 2, y),
                     latLong.at(latLong.width / 2, y));
  return latLong;
}

// Finds the maximum, and the fraction of texels that reach it.
void measureMaximum(const Image& image, LoadedProbe& probe) {
  const size_t width = size_t(image.width), height = size_t(image.height);
  std::vector<float> maxima(height);  // by row
  forRanges(height, width, [&](size_t begin, size_t end) {
    for (size_t y = begin; y < end; ++y)
      for (int x = 0; x < image.width; ++x)
        maxima[y] = std::max(maxima[y], maxComponent(image.rgb(x, int(y))));
  });
  probe.maximum = std::max(probe.maximum, *std::max_element(maxima.begin(), maxima.end()));
  const Rgb first = image.rgb(0, 0);
  std::atomic<size_t> atMaximum = 0, equalToFirst = 0;
  forRanges(height, width, [&](size_t begin, size_t end) {
    size_t maximal = 0, equal = 0;
    for (size_t y = begin; y < end; ++y)
      for (int x = 0; x < image.width; ++x) {
        const Rgb texel = image.rgb(x, int(y));
        maximal += maxComponent(texel) == probe.maximum;
        equal += texel == first;
      }
    atMaximum += maximal;
    equalToFirst += equal;
  });
  const size_t all = width * height;
  if (equalToFirst < all) probe.fractionAtMaximum = double(atMaximum) / double(all);
}

LoadedProbe probeOf(ImageFile&& file, const std::filesystem::path& path, std::string_view mapping,
                    std::string_view mappingLocation) {
  const std::optional<Mapping> stated = openExrMapping(file),
                               named = namedMapping(file.metadata, sizeOf(file));
  const std::string* name = textOf(file.metadata, kMappingAttribute);
  const std::string otherName = name ? printableName(*name) : "";
  LoadedProbe probe;
  probe.hasIntegerTexels = file.integers;
  probe.messages = std::move(file.messages);
  Image image = colorOf(std::move(file), path);
  probe.fileWidth = image.width;
  probe.fileHeight = image.height;
  if (const auto given = parseMapping(mapping, image.width, image.height, mappingLocation)) {
    probe.mapping = *given;
  } else {
    const DetectedMapping detected =
        stated  ? DetectedMapping{*stated, "its `envmap` attribute defines it", true}
        : named ? DetectedMapping{*named, "the file names it", true}
                : detectMapping(image);
    if (!stated && !named && image.width == image.height && isCubeFace(path))
      throwInput(
          "{}: is one face of a cube map, whose probe is the folder {}; give the mapping if the "
          "file is a whole probe",
          path.string(), path.has_parent_path() ? path.parent_path().string() : ".");
    probe.mapping = detected.mapping;
    probe.detected = true;
    probe.certain = detected.certain;
    probe.reason = detected.reason;
    if (!otherName.empty() && !stated && !named)
      addNote(probe.messages, "{}: its `mapping`, {}, is unknown, or not one of {} x {} texels",
              path.string(), otherName, image.width, image.height);
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
    checkImageSize(path, size.width, size.height, 3);
    checkImageMemory(path, size.width, size.height, 3);
    probe.latLong = convert(image, probe.mapping, Mapping::LatLong, size);
  }
  return probe;
}

// Whether a texel is outside the mapping's valid area with all of its corners: a disc's rim lights
// texels whose centres are outside.
bool isOutside(const Image& image, Mapping mapping, int x, int y) {
  constexpr double kLow = 0.01, kHigh = 1 - kLow;  // in the texel, also where faces border on it
  for (const dvec2& corner :
       {dvec2(kLow, kLow), dvec2(kHigh, kLow), dvec2(kLow, kHigh), dvec2(kHigh, kHigh)})
    if (showsDirection(mapping, {(x + corner.x) / image.width, (y + corner.y) / image.height}))
      return false;
  return true;
}

// Whether the image is black outside the mapping's valid area: at least 9 in 10 texels there are
// below 1/1000 of the mean inside. (Debevec's probes have a copyright notice there.)
bool isBlackOutside(const Image& image, Mapping mapping) {
  double sumInside = 0;
  size_t countInside = 0;
  std::vector<float> outside;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float brightness = maxComponent(image.rgb(x, y));
      if (!std::isfinite(brightness)) continue;
      if (showsDirection(mapping, {(x + 0.5) / image.width, (y + 0.5) / image.height})) {
        sumInside += brightness;
        ++countInside;
      } else if (isOutside(image, mapping, x, y)) {
        outside.push_back(brightness);
      }
    }
  const double limit = 1e-3 * sumInside / double(std::max<size_t>(countInside, 1));
  size_t black = 0;
  for (const float brightness : outside) black += brightness <= limit;
  return 10 * black >= 9 * outside.size();
}

// All of a cube map's faces in one folder.
LoadedProbe loadFaces(const std::filesystem::path& folder, std::string_view mapping,
                      std::string_view mappingLocation) {
  if (mapping != "auto" && mapping != "cube-strip")
    throwInput("{}: {} is a folder with the faces of a cube map, and not {}", mappingLocation,
               folder.string(), mapping);
  const CubeFaces faces = findCubeFaces(folder);
  LoadedProbe probe = probeOf(readCubeFaces(folder, faces), folder, "auto", mappingLocation);
  probe.reason = "its folder has the six faces";
  for (const auto& face : faces.files) probe.files.push_back(face.string());
  return probe;
}

}  // namespace

LoadedProbe loadProbe(const std::filesystem::path& path, std::string_view mapping,
                      std::string_view mappingLocation) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    return loadFaces(path, mapping, mappingLocation);
  ImageFile file = readImageFile(path);
  const int width = file.image.width, height = file.image.height;
  try {
    LoadedProbe probe = probeOf(std::move(file), path, mapping, mappingLocation);
    probe.files = {path.string()};
    return probe;
  } catch (const std::bad_alloc&) {
    // The map as read, and as converted or turned.
    const double bytes = 2 * sizeof(Rgb) * double(width) * height;
    throwInput("{}: a probe of {} x {} texels takes {:.2g} GB to load, more than this process gets",
               path.string(), width, height, 1e-9 * bytes);
  }
}

LoadedProbe loadProbe(Image image, std::string_view mapping, std::string_view mappingLocation,
                      const std::string& name) {
  if (image.channels != 3 || image.width < 1 || image.height < 1)
    throwInput("{}: is {} x {} with {} channels; a probe has 3", name, image.width, image.height,
               image.channels);
  for (size_t i = 0; i < image.texels.size(); ++i)
    if (!(image.texels[i] >= 0 && std::isfinite(image.texels[i])))
      throwInput("{}: texel {}, {} must be finite, and not negative", name,
                 i / 3 % size_t(image.width), i / 3 / size_t(image.width));
  ImageFile file;
  file.image = std::move(image);
  file.channels = {"R", "G", "B"};
  return probeOf(std::move(file), name, mapping, mappingLocation);
}

std::vector<std::string> warnings(const LoadedProbe& probe, const std::filesystem::path& path) {
  std::vector<std::string> lines;
  if (!probe.certain)
    lines.push_back(fmt::format(
        "{}: {} x {} texels detected as {} because {}; give the mapping if this is wrong",
        path.string(), probe.fileWidth, probe.fileHeight, mappingName(probe.mapping),
        probe.reason));
  if (probe.turned)
    lines.push_back(fmt::format(
        "{}: turned by 180 degrees because its `envmap` attribute puts +Z in the centre",
        path.string()));
  if (!probe.detected && probe.mapping == Mapping::LatLong && probe.fileWidth == probe.fileHeight)
    lines.push_back(fmt::format(
        "{}: is square but read as a lat-long map (2:1); is it an angular map or a mirror ball?",
        path.string()));
  if (probe.repair.total() > 0)
    lines.push_back(fmt::format("{}: repaired {}", path.string(), describe(probe.repair)));
  for (std::string& line : lightWarnings(probe, path)) lines.push_back(std::move(line));
  return lines;
}

std::string detection(const LoadedProbe& probe, const std::filesystem::path& path) {
  const std::string mapping = mappingName(probe.mapping);
  return fmt::format("{}: detected as {} {} probe because {}", path.string(),
                     mapping.starts_with('a') ? "an" : "a", mapping, probe.reason);
}

Messages probeMessages(const LoadedProbe& probe, const std::filesystem::path& path) {
  Messages messages = probe.messages;
  if (probe.detected && probe.mapping == Mapping::AngularMap)  // or a mirror ball
    addNote(messages, "{}", detection(probe, path));
  for (std::string& line : warnings(probe, path))
    messages.push_back({Message::Kind::Warning, std::move(line)});
  return messages;
}

std::vector<std::string> lightWarnings(const LoadedProbe& probe,
                                       const std::filesystem::path& path) {
  // Fractions of the texels at the maximum. A map that is constant except for a few texels is not a
  // clipped photograph.
  constexpr double kMinClipped = 1e-3, kMaxClipped = 0.9;
  constexpr float kMaxHalf = 65504;
  if (probe.maximum == 0) return {fmt::format("{}: is black: it lights nothing", path.string())};
  if (probe.hasIntegerTexels)
    return {
        fmt::format("{}: has integer texels, so radiance above 1 was clipped when it was made; use "
                    "an .exr or .hdr",
                    path.string())};
  const bool atLimit = probe.maximum == 1 || probe.maximum == kMaxHalf;
  if (atLimit && probe.fractionAtMaximum >= kMinClipped && probe.fractionAtMaximum <= kMaxClipped)
    return {fmt::format(
        "{}: {:.2g}% of its texels have the maximum value, {}: brighter light was clipped",
        path.string(), 100 * probe.fractionAtMaximum, probe.maximum)};
  return {};
}

std::optional<Mapping> namedMapping(const Metadata& metadata, const ImageSize& size) {
  const std::string* name = textOf(metadata, kMappingAttribute);
  if (!name) return std::nullopt;
  try {
    return parseMapping(*name, size.width, size.height, kMappingAttribute);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

DetectedMapping detectMapping(const Image& image) {
  const int w = image.width, h = image.height;
  if (w == 2 * h) return {Mapping::LatLong, "its shape is 2:1", true};
  if (w == 6 * h) return {Mapping::HorizontalStrip, "its shape is 6:1", true};
  if (h == 6 * w) return {Mapping::VerticalStrip, "its shape is 1:6", true};
  // Smaller images are too coarse to detect a disc, a cross or a grid of faces.
  constexpr int kMin = 12;
  if (h >= kMin && w == h)
    return isBlackOutside(image, Mapping::AngularMap)
               ? DetectedMapping{Mapping::AngularMap,
                                 "it is square and black outside the disc (so may be a mirror "
                                 "ball, which only its maker can tell)",
                                 true}
               : DetectedMapping{Mapping::MirrorBall, "it is square and not black outside the disc",
                                 false};
  if (h >= kMin && h % 4 == 0 && 3 * h == 4 * w)
    return {Mapping::VerticalCross, "its shape is 3:4",
            isBlackOutside(image, Mapping::VerticalCross)};
  if (h >= kMin && h % 3 == 0 && 4 * h == 3 * w)
    return {Mapping::HorizontalCross, "its shape is 4:3",
            isBlackOutside(image, Mapping::HorizontalCross)};
  if (h >= kMin && w % 3 == 0 && 2 * w == 3 * h)
    return {Mapping::CubeGrid, "its shape is 3:2", false};
  return {Mapping::LatLong, "no other mapping has its shape", false};
}

}  // namespace chromeball
