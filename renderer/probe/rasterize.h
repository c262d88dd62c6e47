// SPDX-License-Identifier: Apache-2.0
// Images of functions of direction, in any mapping.
#pragma once

#include <functional>

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

// Each texel is the mean of `radiance` over its solid angle, from samplesPerSide^2 samples; black
// where the mapping shows no direction. Three channels. `radiance` takes unit directions and is
// called concurrently.
Image rasterize(Mapping mapping, const ImageSize& size, int samplesPerSide,
                const std::function<dvec3(const dvec3&)>& radiance);

}  // namespace chromeball
