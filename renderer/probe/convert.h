// SPDX-License-Identifier: Apache-2.0
// From one omnidirectional mapping to another.
#pragma once

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

// The lat-long map whose texels are no coarser than those of an image in `mapping` are in its
// centre (of a face): height D/2 for an angular map of diameter D, pi D/4 for a mirror ball, twice
// a cube's face, each rounded up to even; 2:1. A lat-long map keeps its size.
ImageSize latLongSize(Mapping mapping, const ImageSize& image);

// The size at which an image in `mapping` keeps what a lat-long map of `latLong` shows: the inverse
// of latLongSize.
ImageSize sizeFor(Mapping mapping, const ImageSize& latLong);

// Resamples the first three channels; the environment is turned about +Y by `rotationDegrees`,
// counter-clockwise seen from above. Each texel becomes the mean over its solid angle of the
// source's bilinear interpolation (a lat-long source: Probe), which never reads outside the disc or
// the faces. So the mean radiance over the sphere is kept, to 0.1% for what both images resolve.
// What shows no direction becomes black. With nothing to change, the image is copied. All texels
// must be finite. Throws InputError where `size` does not fit `to`.
Image convert(const Image& image, Mapping from, Mapping to, const ImageSize& size,
              float rotationDegrees = 0);

// A cube map or disc as a lat-long map of latLongSize, the environment turned by `rotation` (any
// rotation: the direction d of the source becomes rotation * d).
Image latLongOf(const Image& image, Mapping from, const glm::dmat3& rotation);

}  // namespace chromeball
