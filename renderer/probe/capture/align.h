// SPDX-License-Identifier: Apache-2.0
// The rotation between two probes of one place.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "image/image.h"
#include "math/rotation.h"

namespace chromeball {

// A rotation that makes the second probe look like the first.
struct ProbeFit {
  Rotation rotation;
  double correlation;  // of log radiance over the sphere, of all channels together: 1 if they agree
};

struct ProbeAlignment : ProbeFit {
  // Standard errors of the rotation about X, Y and Z, in degrees, from the scatter of the residuals
  // over 80 parts of the sphere.
  glm::dvec3 standardErrors{0};
  // The other rotations that fit as well. If there are any, the answer is ambiguous.
  std::vector<ProbeFit> others;
  // All of them are turned from the first about this axis: the place is symmetric about it.
  std::optional<glm::dvec3> axis;

  double standardError() const { return glm::length(standardErrors); }  // of the angle
};

// Finds the rotation of `second` for which the correlation with `first` is greatest, over all of
// SO(3); both are finite lat-long maps of any size. They may differ in exposure and white balance,
// as radiance is compared in its logarithm, channel by channel without their means. First all
// rotations of a grid of 11 degrees are tried with maps of 32 x 16 texels; then the best are
// refined by Gauss-Newton steps with larger and larger maps, up to 1024 x 512. Throws InputError,
// begun by a name, for a map of the same radiance in all directions.
ProbeAlignment alignProbes(const Image& first, const Image& second, std::string_view firstName,
                           std::string_view secondName);

// Whether the camera moved between two photographs.

// A point at (x, y) in one photograph is at (x + dx, y + dy) in the other, in pixels.
struct Shift {
  int dx = 0, dy = 0;
  // The fraction of the pixels that are above a percentile in one of the photographs and below it
  // in the other: compared without a shift, and with this one.
  double mismatch = 0, mismatchShifted = 0;

  // Whether the shift is at least 2 pixels and a clear improvement: motion in the scene is no
  // shift.
  bool isCertain() const;
};

// Ward (2003), "Fast, robust image registration for compositing high dynamic range photographs from
// handheld exposures": bitmaps of the pixels above a percentile, which neither exposure nor
// response changes, compared from coarse to fine, for shifts of up to 63 pixels and an eighth of
// the shorter side. Instead of the median, uses the middle one of the percentiles that both
// photographs show well, in green. No shift if there is none. `from` and `to` are levels, white at
// 1, of one size.
Shift findShift(const Image& from, const Image& to);

}  // namespace chromeball
