// SPDX-License-Identifier: Apache-2.0
// A light stage under a probe, of all its numbers or of the largest alone (HDRI book, section
// 9.9.2).
#pragma once

#include "relight/relight.h"
#include "relight/stage_bands.h"

namespace chromeball {

// Of the numbers in the domain, those of largest magnitude that are kept.
struct KeptShares {
  double stage = 1, light = 1;  // above 0, up to 1

  bool isAll() const { return stage == 1 && light == 1; }
};

struct RelitStage {
  Image picture;  // with the scene's own light
  // Where not all is kept: shares of numbers that are zeros, and relativeDifference() of the sums.
  double zeros = 0, lightZeros = 0, error = 0;
};

// The sum over the elements of element times weight, in a domain. A stage of several bands is read
// twice if some of it is left out. The bits do not depend on the bands.
RelitStage relitStage(StageBands& stage, const std::vector<Rgb>& weights, RelightDomain domain,
                      const KeptShares& kept);

// What that takes besides the bands, at most, with the picture's file. Bytes.
double relitStageBytes(int width, int height);

}  // namespace chromeball
