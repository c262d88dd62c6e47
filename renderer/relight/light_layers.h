// SPDX-License-Identifier: Apache-2.0
// Light groups mixed anew: light is additive, so a picture under other lights is a weighted sum of
// its layers (HDRI book, section 9.9.1; Madsen et al. 2003, section 4).
#pragma once

#include <span>

#include "image/image.h"

namespace chromeball {

// The sum of at least one layer of three channels, all of one size. Each pixel is added in double
// in the order of the layers and rounded once, so that equal layers give equal bits.
Image sumOf(std::span<const Image> layers);

Image scaled(Image layer, const Rgb& gain);

// By what factor the picture darkens where the light of one layer is blocked: (whole - layer) /
// whole, limited to 0..1; 1 where the picture is black.
Image shadowMatte(const Image& whole, const Image& layer);

}  // namespace chromeball
