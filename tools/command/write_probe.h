// SPDX-License-Identifier: Apache-2.0
// Writes the map that a command about probes makes.
#pragma once

#include <string>

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

// Returns the size of a map to make for `file`. Throws InputError if `copies` of it, including
// those for writing, take more memory than the process may use.
ImageSize checkedSize(const std::string& file, const ImageSize& size, double copies = 3);

// Copies of a map of irradiance: the direction and the horizon of each texel are kept.
inline constexpr double kIrradianceCopies = 8;

// The same as writeImage(); an .exr or .hdr stores the name of its mapping, which loadProbe()
// reads. Warns of a mapping that other files lose, of channels above 1 that a .png clips, and of
// channels below 0 that become 0 in a .png and an .hdr.
void writeProbe(const std::string& file, const Image& map, Mapping mapping = Mapping::LatLong);

}  // namespace chromeball
