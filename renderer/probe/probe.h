// The light probe: one radiance function of direction, used by everything that looks at the probe.
#pragma once

#include <vector>

#include "image/image.h"
#include "math/vec.h"

namespace chromeball {

// Bilinear interpolation of a lat-long image's texels: wraps at the seam, and reaches at each pole
// the mean of the row beside it, so it is continuous on the whole sphere.
class Probe {
 public:
  // `latLong` has at least three channels and no invalid texel (repair.h). `rotationDegrees` turns
  // the environment about +Y, counter-clockwise seen from above. Throws InputError where a texel
  // times `scale` is not finite.
  explicit Probe(const Image& latLong, float rotationDegrees = 0, float scale = 1);

  // Radiance arriving from `direction` (unit, pointing away from the scene).
  Rgb radiance(const vec3& direction) const;

  int width() const { return width_; }
  int height() const { return height_; }
};

}  // namespace chromeball
