// A probe's file as a lat-long map that is fit to render with.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "image/image.h"
#include "probe/mapping.h"
#include "probe/repair.h"

namespace chromeball {

struct LoadedProbe {
  Image latLong;                       // three channels, finite, not negative
  Mapping mapping = Mapping::LatLong;  // of the file
  int fileWidth = 0, fileHeight = 0;
  bool guessed = false, certain = true;  // how the mapping is known; certain: no warning needed
  std::string reason;                    // of the guess: "its shape is 2:1"
  RepairReport repair;
};

// `mapping` is a name as on the command line; "auto" guesses. A lat-long file of any shape keeps
// its texels; others are converted at latLongSize (convert.h). Throws InputError, begun by
// `mappingPlace` where the mapping is at fault.
LoadedProbe loadProbe(const std::filesystem::path& path, std::string_view mapping = "auto",
                      std::string_view mappingPlace = "--probe-mapping");

// What is worth telling the user on standard error, "FILE: ..." each; often nothing.
std::vector<std::string> warnings(const LoadedProbe& probe, const std::filesystem::path& path);

}  // namespace chromeball
