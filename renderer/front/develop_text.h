// SPDX-License-Identifier: Apache-2.0
// The steps of developing (image/develop/develop.h), as options of `chromeball image develop` and
// as the setting `develop` of a render.
#pragma once

#include <string_view>

#include "image/develop/develop.h"

namespace chromeball {

// Sets one of
//   clip=X, depth-blur=FOCUS:APERTURE, motion=LENGTH@ANGLE, bloom=WEIGHT:SIGMA,...,
//   glare=spencer, vignette=STRENGTH.
// Precondition: `name` is one of these. The weights of a bloom must sum to 1 within 1%, and are
// made to sum to 1. Throws InputError, begun by `location`.
void setDevelop(DevelopSettings& settings, std::string_view name, std::string_view text,
                std::string_view location);

// Sets all of "bloom=.75:1,.25:32 vignette=.4". Throws InputError, begun by `location`.
DevelopSettings parseDevelop(std::string_view text, std::string_view location);

}  // namespace chromeball
