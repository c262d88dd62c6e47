// SPDX-License-Identifier: Apache-2.0
// Edits of a lat-long probe in place, of its first three channels: to sculpt light that was
// captured (HDRI book, sections 9.1 and 9.4.4). Texels are constant over their area.
#pragma once

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

// Everything below the horizon becomes `radiance`. The middle row of an odd number of rows is half
// below it, and becomes the mean of both.
void replaceBelowHorizon(Image& latLong, const Rgb& radiance);

// Below the horizon the sky is seen mirrored: radiance from (x, -y, z) as from (x, y, z).
void mirrorAtHorizon(Image& latLong);

// Left and right are exchanged: radiance from (x, y, z) as from (-x, y, z).
void mirrorLeftAndRight(Image& latLong);

// Multiplies the texels whose centres lie at most `radius` degrees from `centre` (unit). The other
// texels keep their bits. Returns the number of texels that are multiplied.
size_t multiplyRegion(Image& latLong, const dvec3& centre, double radius, const Rgb& gain);

void multiply(Image& latLong, const Rgb& scale);

// Channels above `limit` become `limit`.
void clip(Image& latLong, float limit);

// Replaces the texels whose centres lie less than `radius` degrees from straight down (a tripod) by
// the harmonic function that continues the adjacent row: the smoothest one, without extrema of its
// own. `radius` is at most 90. Returns the number of rows replaced; 0 if the texels are too coarse.
int fillNadir(Image& latLong, double radius);

}  // namespace chromeball
