// SPDX-License-Identifier: Apache-2.0
// What guided bounces gain, estimated from the records of a training.
#pragma once

#include <span>

#include "film/noise.h"
#include "integrate/context.h"
#include "integrate/tile_grid.h"

namespace chromeball {

// The fraction of bounces from the lobes that makes variances times time least; 0, unless `always`:
// none. `records`: by tile, of a fraction of the pixels, with `samples` each.
float bestFraction(std::span<const GuideRecords> records, double fractionOfPixels,
                   const TileGrid& tiles, const PixelErrors& errors, uint32_t samples, bool always);

}  // namespace chromeball
