// SPDX-License-Identifier: Apache-2.0
// How different two pictures look to someone who flips between them (Andersson et al. 2020, "FLIP:
// A Difference Evaluator for Alternating Images"; for HDR, Andersson et al. 2021).
#pragma once

#include "image/image.h"

namespace chromeball {

// A screen 0.7 m wide of 3840 pixels, seen from 0.7 m.
inline constexpr double kPixelsPerDegree = 0.7 * 3840 / 0.7 * 3.14159265358979323846 / 180;

// Per pixel, one channel, 0 (the same) to 1. Both are RGB of one size, display-linear in [0, 1];
// what lies outside is clipped. Throws InputError where sizes differ.
Image flip(const Image& reference, const Image& test, double pixelsPerDegree = kPixelsPerDegree);

// The largest of the errors at several exposures: from the one that brings the reference's
// brightest luminance to 0.85 of the screen's white to the one that does so with its median, about
// a stop apart. Radiance; the tone mapper is ACES as Narkowicz fitted it.
Image hdrFlip(const Image& reference, const Image& test, double pixelsPerDegree = kPixelsPerDegree);

}  // namespace chromeball
