// SPDX-License-Identifier: Apache-2.0
// Removes noise from the texels of charts.
#pragma once

#include "bake/atlas.h"
#include "bake/bake.h"
#include "image/image.h"

namespace chromeball {

// The light of each point, filtered by nonlocal means (Rousselle et al. 2012): each half of the
// samples is averaged over the texels of the same chart whose surroundings are alike in the other
// half, up to the noise of both. Constant light stays the same to the last bit. Buried points take
// no part. `points`: of texels of a page of this size.
std::vector<Rgb> filteredLight(const std::vector<BakePoint>& points, const BakeResult& baked,
                               int size);

// Fills the texels of a page that have no light of their own.

// Within the place of each chart: ring by ring the mean of the neighbours that are filled, so that
// filtering across the edge of a chart, and around points inside of bodies, sees the chart's own
// light. A place without any light is black; the rest of the page has the mean of its light.
// `isBaked`: by texel.
void fillPage(Image& page, std::vector<uint8_t> isBaked, const Atlas& atlas);

}  // namespace chromeball
