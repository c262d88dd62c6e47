// SPDX-License-Identifier: Apache-2.0
// Extracts concentrated sources from a probe, as discs of constant radiance.
#pragma once

#include <vector>

#include "image/image.h"
#include "math/vec.h"

namespace chromeball {

// A sun: a distant disc of constant radiance.

struct Sun {
  glm::dvec3 direction;   // unit, towards its centre
  glm::dvec3 irradiance;  // on a surface that faces it
  double angle;           // angular diameter, degrees; above 0, at most 90

  glm::dvec3 radiance() const;  // irradiance / (pi sin^2(angle / 2))

  // Irradiance on a surface with unit `normal`, whose horizon may cut the disc.
  glm::dvec3 irradianceOn(const glm::dvec3& normal) const;
};

struct SunExtraction {
  std::vector<Sun> suns;  // in order of decreasing irradiance
  Image remainder;        // the map without them, three channels
};

// A sun is a connected region of texels with more than 2000 times the mean luminance of the sphere
// (less on maps too coarse to resolve a sun). The region is at most 6 degrees wide, unless it is
// one or two texels, and contributes with its glow at least 1% of the flux. The glow ends where the
// median of a ring around the sun is at most 20 times the mean, and at a radius of 6 degrees.
// Inside, radiance above the radiance interpolated from the ring belongs to the sun.
//
// The disc has exactly the irradiance of the removed light, and its mean distance from the centre,
// so that surfaces which see half of the disc keep their irradiance too. Together, suns and
// remainder have the irradiance of the map for every normal, to 0.1% of its mean, at 1024 x 512
// texels (constant over each texel) and more; to 1 to 4% at 16 x 8. A map whose texels are too
// coarse for a disc of 90 degrees has no suns.
//
// `latLong` is finite and not negative, and has at least three channels.
SunExtraction extractSuns(const Image& latLong);

// Connected bright texels of a lat-long map.

struct Texel {
  int x, y;
};

// The regions of texels with a luminance above `threshold` that are connected by eight neighbours,
// across the seam too, in the order of their first texels. A source that covers a pole fills the
// row there, which connects it.
std::vector<std::vector<Texel>> brightRegions(const Image& latLong, double threshold);

}  // namespace chromeball
