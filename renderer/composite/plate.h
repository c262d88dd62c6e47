// SPDX-License-Identifier: Apache-2.0
// The photograph that objects are put into.
#pragma once

#include <string>

#include "image/image.h"

namespace chromeball {

// Linear radiance, three channels. EXR, HDR and PFM are linear as they are; integers (JPEG, PNG,
// TIFF) are decoded from sRGB. Throws InputError for what is no image or has a texel that is not
// finite.
Image readPlate(const std::string& path);

// Each pixel is the mean of what it covers of `image`, whose proportions must be those of
// width x height to within half a pixel of either (InputError, beginning with `name`). The same
// size is the same image.
Image scaledPlate(const Image& image, int width, int height, const std::string& name);

}  // namespace chromeball
