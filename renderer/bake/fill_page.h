// SPDX-License-Identifier: Apache-2.0
// Fills the texels of a page that have no light of their own.
#pragma once

#include "bake/atlas.h"
#include "image/image.h"

namespace chromeball {

// Within the place of each chart: ring by ring the mean of the neighbours that are filled, so that
// filtering across the edge of a chart, and around points inside of bodies, sees the chart's own
// light. A place without any light is black; the rest of the page has the mean of its light.
// `isBaked`: by texel.
void fillPage(Image& page, std::vector<uint8_t> isBaked, const Atlas& atlas);

}  // namespace chromeball
