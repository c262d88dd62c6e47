// SPDX-License-Identifier: Apache-2.0
// Edits the first three channels of a lat-long probe in place: to sculpt captured light (HDRI book,
// sections 9.1 and 9.4.4). Texels are constant over their area.
#pragma once

#include <string>

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

// Everything below the horizon becomes `radiance`. The middle row of an odd number of rows is half
// below it, and becomes the mean of both.
void replaceBelowHorizon(Image& latLong, const Rgb& radiance);

// Mirrors the sky below the horizon: radiance from (x, -y, z) as from (x, y, z).
void mirrorAtHorizon(Image& latLong);

// Exchanges left and right: radiance from (x, y, z) as from (-x, y, z).
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

// Counts, locates and replaces invalid texels: NaN, infinite and negative ones.

struct RepairReport {
  // Numbers of texels; each counts once: as NaN if any channel is, else as infinite, else negative.
  size_t nan = 0, infinite = 0, negative = 0;
  int firstX = -1, firstY = -1;  // the first in reading order; -1: none
  bool isBrightest = false;      // one that is not infinite is among the brightest texels

  size_t total() const { return nan + infinite + negative; }
};

// Repairs the first three channels in place. A negative or -infinite channel becomes 0. A texel
// with a NaN becomes the mean of those of its eight neighbours that have none (x wraps if `wrapX`),
// or black if there are none. A +infinite channel becomes the largest finite channel of the image:
// it marks the brightest source, which an average of the neighbours would lose.
RepairReport repair(Image& image, bool wrapX);

// "3 NaN, 1 infinite, 20 negative texels, the first at (5, 7)".
std::string describe(const RepairReport& report);

}  // namespace chromeball
