// SPDX-License-Identifier: Apache-2.0
// Perspective views of a probe: photographs that a camera in its place would take.
#pragma once

#include "image/image.h"
#include "math/rotation.h"
#include "probe/mapping.h"

namespace chromeball {

// The view of a pinhole camera. It looks along -Z, with +Y up, turned by `pose`; `fov` is the
// vertical field of view in degrees, above 0 and below 180: a tile of stitch().
struct PinholeView {
  Rotation pose;
  double fov;
  ImageSize size;

  // The unit direction that it shows at (x, y), in pixels from the top left corner; the centres of
  // pixels are at +0.5.
  glm::dvec3 direction(double x, double y) const;
  double pixelAngle() const;  // of a pixel in the middle, radians
};

// Each pixel is the mean, over its area, of the radiance of a lat-long map as Probe interpolates
// it. Three channels.
Image crop(const Image& latLong, const PinholeView& view);

// The height of a view whose pixels in the middle are as wide as the map's texels.
int rowsOfCrop(const Image& latLong, double fov);

}  // namespace chromeball
