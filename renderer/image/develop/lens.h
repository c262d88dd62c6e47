// SPDX-License-Identifier: Apache-2.0
// What a lens does to an image, after the fact: depth of field, by a blur with the circle of
// confusion of each pixel; and vignetting, which darkens the corners.
#pragma once

#include <cmath>

#include "image/image.h"
#include "math/vec.h"

namespace chromeball {

// An image may be a part of the whole picture, whose middle the axis of the camera passes.
struct ViewFrame {
  int x = 0, y = 0;           // of the image's first pixel in the picture
  int width = 0, height = 0;  // of the picture
  double fov = 0;             // vertical, degrees; 0: unknown

  // The size of a pixel in the middle of the picture, at unit distance along the axis.
  double pixelSize() const { return 2 * std::tan(fov * kPiD / 360) / height; }
  double pixelsPerDegree() const { return kPiD / 180 / pixelSize(); }
};

// Multiplies R, G and B by 1 - strength (1 - cos^4 phi), phi = angle to the camera's axis: the
// natural vignetting of a thin lens at strength 1. Needs the frame's fov.
void vignette(Image& image, double strength, const ViewFrame& frame);

// Multiplies R, G and B by the channels of `falloff`, which is stretched over the picture
// (bilinear). One or at least three channels.
void multiplyFalloff(Image& image, const Image& falloff, const ViewFrame& frame);

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
