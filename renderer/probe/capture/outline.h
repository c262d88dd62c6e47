// SPDX-License-Identifier: Apache-2.0
// The outline of a ball to a fraction of a pixel.
#pragma once

#include <optional>

#include "image/image.h"
#include "probe/capture/circle.h"

namespace chromeball {

struct Outline {
  Circle circle;
  double standardError;  // the largest of those of the centre's coordinates and the radius; pixels
  double support;        // the share of the arcs in the picture that the circle fits, 0 to 1
};

// Fits a circle to the outline of a ball in a picture of one channel, linear luminance. `start` is
// within about two pixels.
//
// Each of many short arcs gives one point. Around it, at the distance d from the outline and t
// along it, in pixels, luminance is that of a background, b0 + b1 d + b2 t, or, inside, of a ball:
// a0 + a1 s + a2 s^2 + a3 t, where s = sqrt(-d). For the cosine of the angle of incidence on the
// ball, and with it what it reflects and its Fresnel reflectance, is a smooth function of s: the
// reflected scene is compressed towards the rim. Each pixel shows the mean over its square. The
// position of the outline with the least squared error over the pixels is the arc's; the curvature
// of that error gives its variance. (This is the slanted edge of ISO 12233, with a model of what is
// inside.) Then a circle is fitted to the points by least squares, each weighed by its variance;
// those far from it do not count (Tukey's biweight). nullopt if too few arcs show an edge.
std::optional<Outline> fitOutline(const Image& image, const Circle& start);

}  // namespace chromeball
