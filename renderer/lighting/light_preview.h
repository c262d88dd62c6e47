// SPDX-License-Identifier: Apache-2.0
// A picture of where directional lights stand in their probe.
#pragma once

#include "image/image.h"
#include "lighting/constellation/directional_light.h"
#include "probe/probe.h"

namespace chromeball {

// The probe as the scene sees it, rotated: a lat-long map of width / 2 rows, tone mapped, in
// display-linear colours.
Image probePicture(const Probe& probe, int width);

// The lat-long map, tone mapped to what a PNG may hold, 1024 x 512, with a white dot at each light.
Image lightPreview(const Image& latLong, const Constellation& lights);

}  // namespace chromeball
