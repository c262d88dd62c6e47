// SPDX-License-Identifier: Apache-2.0
// FLIP: the difference that people perceive when alternating between two images (Andersson et al.
// 2020, "FLIP: A Difference Evaluator for Alternating Images"; for HDR, Andersson et al. 2021).
#pragma once

#include "image/image.h"

namespace chromeball {

// Pixels per degree of a screen that is 3840 pixels and 0.7 m wide, seen from 0.7 m.
inline constexpr double kPixelsPerDegree = 0.7 * 3840 / 0.7 * 3.14159265358979323846 / 180;

// The difference of each pixel, one channel, from 0 (equal) to 1. Both images are RGB, of one size
// and display-linear in [0, 1]; numbers outside are clamped. Throws InputError if sizes differ.
Image flip(const Image& reference, const Image& test, double pixelsPerDegree = kPixelsPerDegree);

// The maximum of the differences at several exposures, for images of radiance. The exposures range,
// about a stop apart, from the one that maps the reference's maximum luminance to 0.85 of the
// screen's white to the one that maps its median luminance to 0.85. The tone mapper is Narkowicz's
// fit of ACES.
Image hdrFlip(const Image& reference, const Image& test, double pixelsPerDegree = kPixelsPerDegree);

}  // namespace chromeball
