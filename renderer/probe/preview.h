// SPDX-License-Identifier: Apache-2.0
// A probe tone mapped for a screen.
#pragma once

#include "image/image.h"
#include "image/tonemap.h"
#include "probe/mapping.h"
#include "probe/probe.h"

namespace chromeball {

// Maps the geometric mean of the luminance, which suns hardly change, to middle grey.
DisplayTransform previewTransform(const Image& latLong);

// The rotated probe as a lat-long map of width / 2 rows, in display-linear colours.
Image probePreview(const Probe& probe, int width);

}  // namespace chromeball
