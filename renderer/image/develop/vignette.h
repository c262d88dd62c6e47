// SPDX-License-Identifier: Apache-2.0
// Vignetting: images that darken towards their corners.
#pragma once

#include "image/develop/view_frame.h"
#include "image/image.h"

namespace chromeball {

// Multiplies R, G and B by 1 - strength (1 - cos^4 phi), phi = angle to the camera's axis: the
// natural vignetting of a thin lens at strength 1. Needs the frame's fov.
void vignette(Image& image, double strength, const ViewFrame& frame);

// Multiplies R, G and B by those of `falloff`, which is stretched over the picture (bilinear). One
// or at least three channels.
void multiplyFalloff(Image& image, const Image& falloff, const ViewFrame& frame);

}  // namespace chromeball
