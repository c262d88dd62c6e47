// SPDX-License-Identifier: Apache-2.0
// Test helpers for constellations: maps, and the light count of each method.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lighting/methods.h"

namespace chromeball {

// The methods whose lights have the same total energy as the map.
std::vector<std::string_view> constellationNames();

// The `count` that gives about `lights` lights; for cube-grid, the largest grid with at most
// `lights`.
int countFor(std::string_view method, int lights);

Constellation make(std::string_view method, const Image& map, int lights, uint64_t seed = 1);

// A map of positive noise, without symmetry or equal texels.
Image noise(int width, int height);

std::vector<Image> realProbes(int maximum);

// A shared probe as a map of 256 x 128 texels; nullopt if it is absent.
std::optional<Image> smallProbe(const std::string& file);

}  // namespace chromeball
