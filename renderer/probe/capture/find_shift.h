// SPDX-License-Identifier: Apache-2.0
// Whether the camera moved between two photographs.
#pragma once

#include "image/image.h"

namespace chromeball {

// What is at (x, y) in one photograph is at (x + dx, y + dy) in the other, in pixels.
struct Shift {
  int dx = 0, dy = 0;
  // The fraction of the pixels that are above a percentile in one of the photographs and below it
  // in the other: compared without a shift, and with this one.
  double mismatch = 0, mismatchShifted = 0;

  // At least 2 pixels, and a clear improvement: what moves in the scene is no shift.
  bool isCertain() const;
};

// Ward (2003), "Fast, robust image registration for compositing high dynamic range photographs from
// handheld exposures": bitmaps of what is brighter than a percentile, which neither exposure nor
// response changes, compared from coarse to fine, for shifts of up to 63 pixels and an eighth of
// the shorter side. In place of the median, the percentile is in the middle of those that both
// photographs show well, in green. No shift if there is none. `from` and `to` are levels, white at
// 1, of one size.
Shift findShift(const Image& from, const Image& to);

}  // namespace chromeball
