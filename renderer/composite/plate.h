// SPDX-License-Identifier: Apache-2.0
// The plate: the background photograph of a composite.
#pragma once

#include <string>

#include "base/message.h"
#include "image/image.h"

namespace chromeball {

// Linear radiance, three channels. EXR, HDR and PFM files are linear; integer files (JPEG, PNG,
// TIFF) are decoded from sRGB. Throws InputError if the file is not an image or has a pixel that is
// not finite.
Image readPlate(const std::string& path, Messages* messages = nullptr);  // gets the reader's

// Resamples with a box filter. The aspect ratios must agree to within half a pixel of either
// dimension, otherwise throws InputError (message beginning with `name`). An image of the requested
// size is returned unchanged.
Image scaledPlate(const Image& image, int width, int height, const std::string& name);

}  // namespace chromeball
