// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/image.h"

namespace chromeball {

// The image as it is to be seen, of one that is stored with this orientation (EXIF and TIFF, tag
// 274: 1 to 8; 6 is to be turned clockwise). Others leave it as it is.
Image oriented(Image stored, int orientation);

}  // namespace chromeball
