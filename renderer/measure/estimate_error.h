// SPDX-License-Identifier: Apache-2.0
// The errors of images under estimated light, as papers on light estimation define them.
#pragma once

#include "image/image.h"

namespace chromeball {

struct EstimateError {
  double rmse = 0;   // the root of the mean of (predicted - true)^2 over pixels and channels
  double scale = 1;  // sum(predicted true) / sum(predicted^2): the best factor on the predicted
  // RMSE of scale x predicted: blind to the exposure, not to colour (Grosse et al. 2009, "Ground
  // truth dataset and baseline evaluations for intrinsic image algorithms", section 4).
  double scaleInvariantRmse = 0;
  // The mean angle between the colours of a pixel as vectors of R, G and B, in degrees: blind to
  // brightness (LeGendre et al. 2019). Over the pixels that are black in neither image; NaN if
  // there are none.
  double angularError = 0;
};

// Over the pixels where `mask` (one channel) is not 0: at least one. All images are of one size.
EstimateError estimateError(const Image& predicted, const Image& truth, const Image& mask);

}  // namespace chromeball
