// SPDX-License-Identifier: Apache-2.0
// Writes the map that a command about probes makes.
#pragma once

#include <string>

#include "image/image.h"

namespace chromeball {

// As writeImage(). Warns of the channels above 1 that a .png clips.
void writeProbe(const std::string& file, const Image& map);

}  // namespace chromeball
