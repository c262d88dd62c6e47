// SPDX-License-Identifier: Apache-2.0
// `cube-grid` (Reinhard et al., HDRI book, Fig. 9.31): a light for each square of a grid on the
// faces of a cube.
#pragma once

#include "lighting/constellation/texel_table.h"

namespace chromeball {

// n x n equal squares on each face, with a light at the centre of each square that is not black,
// with the energy of all cells whose centroid projects into the square.
Constellation cubeGrid(const TexelTable& table, int n);

// The square of each texel's centre; 6 n^2 regions, lit or not.
Partition cubeGridRegions(const Image& latLong, int n);

}  // namespace chromeball
