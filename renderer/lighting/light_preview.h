// SPDX-License-Identifier: Apache-2.0
// An image of a probe with the directional lights that replace it, for `lights --preview`.
#pragma once

#include "image/image.h"
#include "lighting/constellation/directional_light.h"

namespace chromeball {

// The lat-long map, tone mapped to display-linear colours, 1024 x 512, with a white dot at each
// light.
Image lightPreview(const Image& latLong, const Constellation& lights);

}  // namespace chromeball
