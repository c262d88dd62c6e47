// SPDX-License-Identifier: Apache-2.0
// Filling an image from a function of direction.
#pragma once

#include <functional>

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

// The mean over each texel's solid angle of `radiance` (of a unit direction), from `samplesPerSide`
// squared samples a texel; black where the mapping shows nothing. Three channels. `radiance` is
// called concurrently.
Image bake(Mapping mapping, const ImageSize& size, int samplesPerSide,
           const std::function<dvec3(const dvec3&)>& radiance);

}  // namespace chromeball
