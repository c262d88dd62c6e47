// SPDX-License-Identifier: Apache-2.0
// Depth of field after the fact: an image blurred by the circle of confusion of each pixel.
#pragma once

#include "image/develop/vignette.h"
#include "image/image.h"

namespace chromeball {

inline constexpr double kMaxConfusionRadius = 100;  // pixels

// The thin lens of the scene file's [camera].
struct ThinLens {
  double focus;     // metres along the axis
  double aperture;  // diameter, metres
};

// The radius of the circle of confusion of a point at planar depth z, in pixels: (aperture / 2) |z
// - focus| / z / (focus x pixel size), at most kMaxConfusionRadius. 0 if the depth is not above 0.
double confusionRadius(const ThinLens& lens, double depth, const ViewFrame& frame);

// Each pixel becomes the weighted mean of the pixels whose disc of confusion covers it: weight =
// share of the pixel that the disc covers / area of the disc. A pixel further away spreads no
// further over a nearer one than the nearer one is blurred itself, so that the background stays
// behind sharp edges. Pixels in focus keep their bits, unless something nearer is blurred over
// them; a constant image stays constant, up to rounding; the sum of other images changes at edges.
// `depth`: one channel of planar depth in metres, 1e10 where nothing was hit. One depth stands for
// each pixel: surfaces hidden behind blurred edges are not seen, and mirrors and glass are blurred
// like their surfaces. Takes time proportional to the square of the radius. Infinity and NaN
// spread.
Image blurByDepth(const Image& image, const Image& depth, const ThinLens& lens,
                  const ViewFrame& frame);

}  // namespace chromeball
