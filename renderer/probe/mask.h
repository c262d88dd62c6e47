// SPDX-License-Identifier: Apache-2.0
// Parts of a probe that are to give no light.
#pragma once

#include <string_view>

#include "image/image.h"

namespace chromeball {

enum class ProbeMask {
  None,
  BelowHorizon,  // as the sky of Madsen and Laursen 2007, Fig. 3
};

// none or below-horizon. Throws InputError, which starts with `location`, for any other name.
ProbeMask parseProbeMask(std::string_view name, std::string_view location);

// Sets the radiance of the masked directions of a lat-long map to 0. A row that the horizon divides
// (the middle one of an odd number) keeps half of its radiance: the light of its upper half.
void applyMask(ProbeMask mask, Image& latLong);

}  // namespace chromeball
