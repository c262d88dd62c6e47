// SPDX-License-Identifier: Apache-2.0
// A probe as weights of a light stage's elements.
#pragma once

#include <vector>

#include "probe/probe.h"
#include "relight/direction_basis.h"

namespace chromeball {

// Of cells: the mean radiance of the rotated probe over each. Of spherical harmonics: the integral
// of radiance times the function. By quadrature over the bilinear interpolation of the map, each
// point with its exact solid angle, on a grid of at least the map's texels: 4096 x 2048 points or
// more for cells, so that a cell's edge is off by 0.04 degrees at most. Parallel; the same bits for
// any number of threads.
std::vector<Rgb> lightWeights(const DirectionBasis& basis, const Image& latLong,
                              const Rotation& rotation, int leastWidth = 4096);

}  // namespace chromeball
