// SPDX-License-Identifier: Apache-2.0
// Resampling from one omnidirectional mapping to another.
#pragma once

#include <functional>

#include "image/image.h"
#include "image/tonemap.h"
#include "math/rotation.h"
#include "probe/mapping.h"
#include "probe/probe.h"

namespace chromeball {

// Size of the 2:1 lat-long map whose texels are no coarser than those in the centre of an image in
// `mapping` (of a face, for cube maps). Its height is D/2 for an angular map of diameter D, pi D/4
// for a mirror ball, D for an equidistant fisheye disc of 180 degrees (at most 8192), twice a
// cube's face, rounded up to even. A lat-long map keeps its size.
ImageSize latLongSize(Mapping mapping, const ImageSize& image);

// The inverse of latLongSize(): the size at which an image in `mapping` keeps the detail of a
// lat-long map of size `latLong`.
ImageSize sizeFor(Mapping mapping, const ImageSize& latLong);

// Resamples the first three channels and turns the environment. Each texel is the mean, over its
// solid angle, of the source's bilinear interpolation (of Probe, for a lat-long source), which
// never reads outside the disc or the faces. So the mean radiance over the sphere is kept, to 0.1%
// for detail that both images resolve. Texels that show no direction are black, and directions that
// the source does not show (outside the field of view of a fisheye disc). If nothing changes,
// returns a copy. All texels must be finite. Throws InputError if `size` does not fit `to`.
Image convert(const Image& image, Mapping from, Mapping to, const ImageSize& size,
              const Rotation& rotation = {});

// Converts a cube map or disc to a lat-long map of latLongSize(). `rotation` may be any rotation:
// direction d of the source becomes rotation * d.
Image latLongOf(const Image& image, Mapping from, const glm::dmat3& rotation);

// The image of a function of direction: each texel is the mean of `radiance` over its solid angle,
// from samplesPerSide^2 samples; black where the mapping shows no direction. Three channels.
// `radiance` takes unit directions and is called concurrently.
Image rasterize(Mapping mapping, const ImageSize& size, int samplesPerSide,
                const std::function<dvec3(const dvec3&)>& radiance);

// A probe tone mapped for a screen.

// Maps the geometric mean of the luminance, which suns hardly change, to middle grey.
DisplayTransform previewTransform(const Image& latLong);

// The rotated probe as a lat-long map of width / 2 rows, in display-linear colours.
Image probePreview(const Probe& probe, int width);

// Perspective views of a probe: photographs that a camera in its place would take.

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
