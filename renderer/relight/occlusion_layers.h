// SPDX-License-Identifier: Apache-2.0
// Pictures lit by another probe from layers of their surfaces: ambient occlusion times diffuse
// environment mapping (HDRI book, section 9.8.2, figure 9.41).
#pragma once

#include "image/image.h"
#include "math/rotation.h"

namespace chromeball {

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
