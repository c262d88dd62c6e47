// SPDX-License-Identifier: Apache-2.0
// Finds the outline of a ball in a photograph.
#pragma once

#include <optional>

#include "image/image.h"
#include "probe/capture/photograph.h"

namespace chromeball {

struct FoundCircle {
  Circle circle;
  double support;        // the share of the outline inside the picture that is an edge, 0 to 1
  double standardError;  // of the centre's coordinates and the radius, in pixels
};

// The circle that most edges of the picture lie on: edges of the logarithm of luminance, in a copy
// of at most 400 pixels; pairs of them, chosen at random from a fixed seed, propose circles, of
// which the best is fitted by least squares to edges across it, first in the copy and then in the
// picture itself; at last to a fraction of a pixel. Parts of the circle may be outside
// the picture. nullopt if no circle of at least 5% of the picture's shorter side in radius has half
// of its outline on edges, if few arcs of the final fit agree on it, or only to more than a pixel,
// or as many lie elsewhere, such as those of an octagon, or to and fro in equal steps around it,
// such as those of a dodecagon, or if radiance changes there no faster than around it, as in smooth
// pictures.
std::optional<FoundCircle> findCircle(const Image& image);

// The outline of a ball to a fraction of a pixel.

struct Outline {
  Circle circle;
  double standardError;  // the largest of those of the centre's coordinates and the radius; pixels
  double support;        // the share of the arcs in the picture that the circle fits, 0 to 1
  double contradiction;  // the share of those that clearly lie elsewhere: by 1% of the radius
  // Of the arcs' deviations that repeat around the circle, as the corners of a polygon: the
  // amplitude of the largest, in pixels, and its share of the mean square of all.
  double ripple, rippleShare;
};

// Fits a circle to the outline of a ball in a linear picture. `start` is within about two pixels.
//
// Each of many short arcs of 10 pixels has a likelihood of its position (rim_arc.h); the circle is
// the one that all arcs together make likeliest. An arc counts up to a bound, so that one which
// shows another edge, or none, has little to say. The blur of the picture is the likeliest.
//
// Where the ball's rim continues the background, the position depends on how the rim is modelled:
// without a step there, the outline is found further outside. Unless a step is much likelier, the
// circle is between the two. The standard error has two parts: that of the jackknife over twelfths
// of the outline, and half of the distance between the two models' circles. Errors have the
// variances, one or two, with which more arcs agree. Weights and bounds are empirical
// (find_circle_test.cpp). nullopt if too few arcs are in the picture.
std::optional<Outline> fitOutline(const Image& image, const Circle& start);

}  // namespace chromeball
