// SPDX-License-Identifier: Apache-2.0
// Limits pixels that hold so much light that a filter would turn them into bright spots.
#pragma once

#include "denoise/filter.h"

namespace chromeball {

// A pixel of one half of the samples, the sum of whose squared channels exceeds that of the 5 x 5
// pixels around it in the other half, is scaled down to that sum. Rare bright paths are then
// missing from the image; where they are frequent, both halves have them, and nothing changes.
// Returns an estimate of the squared bias of each channel: the product of the mean light that
// either half loses around a pixel. (The square of the loss of both would overestimate it: the
// rarer the paths, the more.)
Plane limitFireflies(HalfPlanes& halves);

}  // namespace chromeball
