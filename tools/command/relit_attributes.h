// SPDX-License-Identifier: Apache-2.0
// The attributes of a render's header that are no longer true once its light is another.
#pragma once

#include "image/io/read_image.h"

namespace chromeball {

void eraseNoise(Metadata& metadata);  // whatever depends on how bright the sources are
// Whatever describes the sources, the paths from them and their samples; the scene and its camera
// stay.
void eraseLight(Metadata& metadata);

}  // namespace chromeball
