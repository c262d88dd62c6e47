// SPDX-License-Identifier: Apache-2.0
#include "image_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/file.h"
#include "image/io/radiance_hdr.h"
#include "image/size_limits.h"
#include "messages.h"
#include "probe/load.h"

namespace chromeball {
namespace {

// A .pfm or .png is read back with the mapping that its shape and its corners suggest.
void warnOfLostMapping(const std::string& file, const Image& map, Mapping mapping) {
  const DetectedMapping detected = detectMapping(map);
  if (detected.mapping == mapping) return;
  // A scene file takes lenses only from files that name them.
  const bool isLens = mapping.kind() == Mapping::FisheyeDisc;
  warn(
      "{}: has no place for its mapping, {}, and will be taken for {}: give `--probe-mapping "
      "{}`{} where it is read, or write an .exr or .hdr",
      file, mappingName(mapping), mappingName(detected.mapping), mappingName(mapping),
      isLens ? "" : " or `[probe] mapping`");
}

}  // namespace

void warnOfClipping(const std::string& file, const Image& image) {
  if (lowerExtension(file) != ".png") return;
  const auto clipped = std::ranges::count_if(image.texels, [](float x) { return x > 1; });
  if (clipped > 0)
    warn("{}: {:.3g}% of the channels are above 1, and clipped; an .exr holds them", file,
         100. * double(clipped) / double(image.texels.size()));
}

ImageFile openImageFile(const std::filesystem::path& path, IntegerTexels integers) {
  ImageFile file = readImageFile(path, integers);
  print(file.messages);
  return file;
}

Image openImage(const std::filesystem::path& path, IntegerTexels integers) {
  return colorOf(openImageFile(path, integers), path);
}

Metadata keptMetadata(Metadata kept, const std::string& in, const std::string& out) {
  const auto envmap = kept.find(kEnvmapAttribute);
  if (envmap == kept.end()) return kept;
  const auto* kind = std::get_if<std::string>(&envmap->second);
  if (kind && *kind == kEnvmapLatLong && lowerExtension(out) != ".png")
    warn(
        "{}: its `envmap` attribute, which puts +Z in the centre, is not kept: as a "
        "probe, {} needs a rotation of 180 degrees",
        in, out);
  kept.erase(envmap);
  return kept;
}

void writeKept(const std::string& out, OutputImage output, const std::string& in,
               const DisplayTransform& transform) {
  const std::string kind = lowerExtension(out);
  if (kind != ".exr") {
    Image& color = output.layers.front().image;
    color = inDisplayWindow(std::move(color), std::exchange(output.placement, {}), in);
    const auto mapping = namedMapping(output.metadata, {color.width, color.height});
    output.metadata.erase(kMappingAttribute);
    if (mapping) output.metadata[kMappingAttribute] = mappingName(*mapping);
    if (mapping && kind == ".pfm") warnOfLostMapping(out, color, *mapping);
  }
  print(writeImage(out, output, transform));
}

LoadedProbe openProbe(const std::string& path, std::string_view mapping, std::string_view option) {
  LoadedProbe probe = loadProbe(path, mapping, option);
  print(probeMessages(probe, path));
  return probe;
}

ImageSize checkedSize(const std::string& file, const ImageSize& size, double copies) {
  checkImageSize(file, size.width, size.height, 3);
  checkImageMemory(file, size.width, size.height, 3, sizeof(float), copies);
  return size;
}

void writeProbe(const std::string& file, const Image& map, Mapping mapping) {
  const std::string kind = lowerExtension(file);
  print(writeImage(file,
                   OutputImage{{{"", "RGB", map}}, {{kMappingAttribute, mappingName(mapping)}}}));
  if (kind == ".exr" || kind == ".hdr") return;
  warnOfLostMapping(file, map, mapping);
  warnOfClipping(file, map);
}

}  // namespace chromeball
