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
// picture itself; at last to a fraction of a pixel (outline.h). Parts of the circle may be outside
// the picture. nullopt if no circle of at least 5% of the picture's shorter side in radius has half
// of its outline on edges, if few arcs of the final fit agree on it, or only to more than a pixel,
// or as many lie elsewhere, such as those of an octagon, or to and fro in equal steps around it,
// such as those of a dodecagon, or if radiance changes there no faster than around it, as in smooth
// pictures.
std::optional<FoundCircle> findCircle(const Image& image);

}  // namespace chromeball
