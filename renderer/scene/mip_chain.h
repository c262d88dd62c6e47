// SPDX-License-Identifier: Apache-2.0
// Smaller versions of a texture, for what is seen from afar.
#pragma once

#include <memory>
#include <vector>

#include "scene/texture.h"

namespace chromeball {

// The grid at half its size, at a quarter, and so on down to one texel. Each texel is the mean, in
// linear light, of those it covers; it is stored as the grid stores its own (`srgb`: encoded).
// Colours weigh in proportion to their alpha where `weightedByAlpha` says so and any has some.
// Empty for a grid of one texel.
std::vector<TexelGrid> makeSmaller(const TexelGrid& grid, bool srgb, bool weightedByAlpha = false);

}  // namespace chromeball
