// SPDX-License-Identifier: Apache-2.0
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
  bool turned = false;  // the file said that its centre looks along +Z (OpenEXR's lat-long maps)
  RepairReport repair;
  bool isScreenImage = false;    // texels of 8 or 16 bits
  float maximum = 0;             // the greatest channel of a texel
  double fractionAtMaximum = 0;  // of the texels; 0 where all are alike
};

// `mapping` is a name as on the command line; "auto" guesses, unless the file is an EXR whose
// attribute `envmap` says what it is. Of such a lat-long map the centre looks along +Z and the left
// quarter along +X (OpenEXR's ImfEnvmap.h), and is turned by half a circle, to agree with the cube
// map of the same place. A lat-long file of any shape keeps
// its texels; others are converted at latLongSize (convert.h). Throws InputError, begun by
// `mappingPlace` where the mapping is at fault.
LoadedProbe loadProbe(const std::filesystem::path& path, std::string_view mapping = "auto",
                      std::string_view mappingLocation = "--probe-mapping");

// What is worth telling the user on standard error, "FILE: ..." each; often nothing.
std::vector<std::string> warnings(const LoadedProbe& probe, const std::filesystem::path& path);

// The part of it that speaks of the light: none, or cut off at the greatest number of its format.
std::vector<std::string> lightWarnings(const LoadedProbe& probe, const std::filesystem::path& path);

}  // namespace chromeball
