// SPDX-License-Identifier: Apache-2.0
// Finds the outline of a ball in a photograph.
#pragma once

#include <optional>
#include <vector>

#include "image/image.h"
#include "probe/capture/photograph.h"

namespace chromeball {

// Edges of a picture.

// One channel: each pixel is the mean luminance of `scale` x `scale` pixels of the image; pixels
// left over on the right and below are left out.
Image meanLuminance(const Image& image, int scale);

// The natural logarithm of the luminance, which is raised to at least 1/1000 of its mean.
Image logarithm(Image luminance);

// Bilinear interpolation of one channel, continued beyond the rim.
double interpolate(const Image& channel, const glm::dvec2& position);

// A point of an edge: a pixel in which the gradient is larger than at its two neighbours along it.
struct EdgePoint {
  glm::dvec2 position;
  glm::dvec2 normal;  // unit, along the gradient
};

// Edges with the largest gradients: at most `share` of the pixels. Also the index of each pixel's
// edge point in `points`, or -1.
struct EdgeMap {
  int width = 0, height = 0;
  std::vector<EdgePoint> points;
  std::vector<int> index;

  EdgeMap(const Image& channel, double share);
  const EdgePoint* at(int x, int y) const {
    if (x < 0 || y < 0 || x >= width || y >= height) return nullptr;
    const int i = index[size_t(y) * width + x];
    return i < 0 ? nullptr : &points[size_t(i)];
  }
};

// The circle.

struct FoundCircle {
  Circle circle;
  double support;        // the share of the outline inside the picture that is an edge, 0 to 1
  double standardError;  // of the centre's coordinates and the radius, in pixels
  std::optional<Circle> other;  // one elsewhere that may be the outline as well
};

// The circle that most edges of the picture lie on: edges of the logarithm of luminance, in a copy
// of at most 400 pixels; pairs of them, chosen at random from a fixed seed, propose circles. The
// best is fitted by least squares to edges across it, first in the copy and then in the picture
// itself, finally to a fraction of a pixel. Parts of the circle may be outside the picture. nullopt
// if no circle of at least 5% of the picture's shorter side in radius has half of its outline on
// edges, if few arcs of the final fit agree on it, or only to more than a pixel, if as many arcs
// lie elsewhere, as with an octagon, or alternate around it in equal steps, as with a dodecagon, or
// if radiance changes there no faster than around it, as in smooth pictures. A second search, for
// circles that differ from the first, finds `other`.
std::optional<FoundCircle> findCircle(const Image& image);

// The outline of a ball to a fraction of a pixel.

struct Outline {
  Circle circle;
  double standardError;  // the largest for the centre's coordinates and the radius; pixels
  double support;        // the share of the arcs in the picture that the circle fits, 0 to 1
  double contradiction;  // the share of arcs that clearly lie elsewhere: by 1% of the radius
  // The largest of the arcs' deviations that repeat around the circle, like the corners of a
  // polygon: its amplitude in pixels, and its share of the mean square of all deviations.
  double ripple, rippleShare;
};

// Fits a circle to the outline of a ball in a linear picture. `start` is within about two pixels.
//
// Each of many short arcs of 10 pixels has a likelihood of its position (rim_arc.h); the circle is
// the one that all arcs together make likeliest. An arc's influence is bounded, so that one which
// shows another edge, or none, has little. The picture's blur is the likeliest too.
//
// Where the ball's rim continues the background, the position depends on how the rim is modelled:
// without a step there, the outline is found further outside. Unless a step is much likelier, the
// circle is between the two. The standard error has two parts: the jackknife error over twelfths of
// the outline, and half of the distance between the two models' circles. Errors have one variance
// or two, whichever more arcs agree with. Weights and bounds are empirical (find_circle_test.cpp).
// nullopt if too few arcs are in the picture.
std::optional<Outline> fitOutline(const Image& image, const Circle& start);

}  // namespace chromeball
