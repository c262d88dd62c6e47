// SPDX-License-Identifier: Apache-2.0
// `cube-grid` (HDRI book, Fig. 9.31): a light for each square of a grid on the faces of a cube.
#pragma once

#include "lighting/constellation/texel_table.h"

namespace chromeball {

// n x n equal squares on each face; a light in the middle of each has the light of all texels whose
// centres are seen through the square, however they are spread over it. 6 n^2 lights less those of
// black squares. `table`: of kFineCells.
Constellation cubeGrid(const TexelTable& table, int n);

}  // namespace chromeball
