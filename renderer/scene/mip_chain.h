// SPDX-License-Identifier: Apache-2.0
// Mip levels of a texture.
#pragma once

#include <memory>
#include <vector>

#include "scene/texture.h"

namespace chromeball {

// The grid at half its size, at a quarter, and so on down to one texel; empty for a grid of one
// texel. Each texel is the mean, in linear light, of the texels it covers, stored like those of the
// grid (`srgb`: encoded). With `weightedByAlpha`, colours are weighted by alpha unless all alphas
// are 0.
std::vector<TexelGrid> makeMipLevels(const TexelGrid& grid, bool srgb,
                                     bool weightedByAlpha = false);

}  // namespace chromeball
