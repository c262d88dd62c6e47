// SPDX-License-Identifier: Apache-2.0
// Constellations by name: the light of a whole probe as a number of directional lights.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "image/image.h"
#include "lighting/constellation/directional_light.h"

namespace chromeball {

// What all methods share. The irradiances add up to the sum over texels of radiance times solid
// angle, channel by channel. Directions are unit, no light is black or negative, and the same
// arguments give the same bits. There are `count` lights where the map has as many lit texels
// (blocks of texels, where it is large), else one for each; a black map gives none. cube-grid:count
// asks for 6 count^2 lights, less those whose square is black; penrose gives `count` lights to any
// map that is not black. The seed matters to lightgen, kollig-keller-strata and penrose.
//
// `latLong` has at least three channels. Throws InputError for an unknown method, a count out of
// range (2 to 4096; 1 to 26 for cube-grid), or a texel that is negative or not finite.
Constellation makeConstellation(const std::string& method, const Image& latLong, int count,
                                uint64_t seed);

std::vector<std::string_view> constellationNames();

}  // namespace chromeball
