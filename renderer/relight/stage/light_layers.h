// SPDX-License-Identifier: Apache-2.0
// Mixes light groups anew: light is additive, so a picture under other lights is a weighted sum of
// its layers (HDRI book, section 9.9.1; Madsen et al. 2003, section 4).
#pragma once

#include <span>

#include "image/image.h"
#include "math/rotation.h"

namespace chromeball {

// The sum of at least one layer of three channels, all of one size. Each pixel is added in double
// in the order of the layers and rounded once, so that equal layers give equal bits.
Image sumOf(std::span<const Image> layers);

Image scaled(Image layer, const Rgb& gain);

// The factor by which the picture darkens where the light of one layer is blocked: (whole - layer)
// / whole, limited to 0..1; 1 where the picture is black.
Image shadowMatte(const Image& whole, const Image& layer);

// Pictures lit by another probe from layers of their surfaces: ambient occlusion times diffuse
// environment mapping (HDRI book, section 9.8.2, figure 9.41).

// Layers of one size, as in film/aov.h.
struct OcclusionLayers {
  Image albedo;  // times coverage
  Image normal;  // of any length: the surface's, or the bent one
  Image ambientOcclusion;
};

// albedo / pi ao E(n) of each pixel, with E the exact irradiance from `latLong` turned by
// `rotation`; black where there is no normal. All surfaces count as diffuse, and light that they
// reflect to each other is missing.
Image relit(const OcclusionLayers& layers, const Image& latLong, const Rotation& rotation);

}  // namespace chromeball
