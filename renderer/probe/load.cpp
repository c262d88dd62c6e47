#include "probe/load.h"

#include <fmt/format.h>

#include "image/read.h"
#include "probe/convert.h"
#include "probe/guess.h"

namespace chromeball {

LoadedProbe loadProbe(const std::filesystem::path& path, std::string_view mapping,
                      std::string_view mappingPlace) {
  Image image = readImage(path);
  LoadedProbe probe;
  probe.fileWidth = image.width;
  probe.fileHeight = image.height;
  if (const auto given = parseMapping(mapping, image.width, image.height, mappingPlace)) {
    probe.mapping = *given;
  } else {
    MappingGuess guess = guessMapping(image);
    probe.mapping = guess.mapping;
    probe.guessed = true;
    probe.certain = guess.certain;
    probe.reason = std::move(guess.reason);
  }

  const bool isLatLong = probe.mapping == Mapping::LatLong;
  probe.repair = repair(image, isLatLong);
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
  if (probe.repair.total() > 0)
    lines.push_back(fmt::format("{}: repaired {}", path.string(), describe(probe.repair)));
  return lines;
}

}  // namespace chromeball
