// SPDX-License-Identifier: Apache-2.0
// The flat-field response of a camera: how its lens darkens the image towards the corners.
#pragma once

#include <span>

#include "image/image.h"

namespace chromeball {

using glm::dvec2;
using glm::dvec3;

// The radiance that a camera recorded from a constant source at `position` (pixels).
struct SourceSample {
  dvec2 position;
  dvec3 radiance;
};

// The brightest spot of a photograph: the centroid of the luminance above half its maximum.
dvec2 findSource(const Image& photograph);

// The mean of the pixels whose centres are within `radius` of `position`, or of the pixel there.
// Throws InputError, begun by `name`, if the disc is not inside the image or a channel is not
// finite and above 0.
SourceSample measureSource(const Image& photograph, const dvec2& position, double radius,
                           const std::string& name);

// v(r) = 1 + a2 r^2 + a4 r^4 + a6 r^6 for each channel, r = distance from `centre` / `unit`.
struct FlatField {
  dvec2 centre;        // pixels
  double unit;         // pixels: half of the image's diagonal
  dvec3 a2, a4, a6;    // of the channels
  double largest = 0;  // the largest r of a sample: beyond 1.1 times that, v keeps its value there
  dvec3 rmsError;      // of the samples, relative to the fit

  dvec3 at(const dvec2& position) const;
  Image image(int width, int height) const;  // three channels
};

// The least-squares fit of s v(r) to the samples, where the source's radiance s is unknown (HDRI
// book, section 9.3.3). Throws InputError if the samples have fewer than four different r, and if v
// is not above 0 everywhere.
FlatField fitFlatField(std::span<const SourceSample> samples, int width, int height,
                       const dvec2& centre);

// a / b, channel by channel; 0 where b is not above 0. Three channels, of one size. Returns the
// number of pixels that are 0 for this reason.
size_t divide(Image& a, const Image& b);

}  // namespace chromeball
