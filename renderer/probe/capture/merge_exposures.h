// SPDX-License-Identifier: Apache-2.0
// One image of high dynamic range from photographs that differ in exposure.
#pragma once

#include <span>

#include "probe/capture/exposure.h"
#include "probe/capture/response_curve.h"

namespace chromeball {

struct MergedExposures {
  Image radiance;  // three channels
  Image clipped;  // one channel: 1 where the radiance is only a lower bound in some channel, else 0
  size_t clippedPixels = 0, underexposedPixels = 0;  // in some channel

  struct Use {
    size_t saturated = 0;  // pixels, in some channel
    size_t weighted = 0;   // pixels that the image takes something from
  };
  std::vector<Use> uses;  // of each exposure
};

// Debevec and Malik (1997), eq. 6: ln L is the mean of g(level) - ln k over the exposures, weighted
// by a hat. A channel that is saturated where it is not black is a lower bound: that of the
// shortest exposure that is saturated. One that is black in all exposures, or NaN, is
// under-exposed: 0.
//
// All images have the same size; there is at least one. Parallel; the same bits for any number of
// threads.
MergedExposures mergeExposures(std::span<const Exposure> exposures, const ResponseCurve& response);

}  // namespace chromeball
