// SPDX-License-Identifier: Apache-2.0
// Removes noise from the texels of charts.
#pragma once

#include "bake/bake.h"

namespace chromeball {

// The light of each point, filtered by nonlocal means (Rousselle et al. 2012): each half of the
// samples is averaged over the texels of the same chart whose surroundings are alike in the other
// half, up to the noise of both. Constant light stays the same to the last bit. Buried points take
// no part. `points`: of texels of a page of this size.
std::vector<Rgb> filteredLight(const std::vector<BakePoint>& points, const BakeResult& baked,
                               int size);

}  // namespace chromeball
