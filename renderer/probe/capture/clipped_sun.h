// SPDX-License-Identifier: Apache-2.0
// Where the sun is in a probe whose photographs it saturated.
#pragma once

#include <filesystem>
#include <optional>

#include "probe/load.h"

namespace chromeball {

// A connected region of texels that are as bright as the probe can show.
struct ClippedSun {
  dvec3 direction;    // unit, towards the centroid of its solid angle
  double width;       // degrees, twice from the centroid to the furthest texel
  size_t rivals = 0;  // other regions with at least half of its solid angle
};

// The layer `clipped` of an .exr, which `probe merge` writes, as the map that the probe was loaded
// as; one channel. nullopt if the file has none. Throws InputError.
std::optional<Image> loadClippedLayer(const std::filesystem::path& path, const LoadedProbe& probe);

// The largest region of the texels that `clipped` (one channel; null: none) marks with more than
// 0.5, else of those with at least 0.98 of the largest luminance. `latLong` is finite and not
// negative. Throws InputError, begun by `name`, if there is none.
ClippedSun findClippedSun(const Image& latLong, const Image* clipped, const std::string& name);

}  // namespace chromeball
