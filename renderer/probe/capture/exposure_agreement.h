// SPDX-License-Identifier: Apache-2.0
// Whether photographs of one view differ as their exposures say.
#pragma once

#include <optional>
#include <span>

#include "probe/capture/exposure.h"
#include "probe/capture/response_curve.h"

namespace chromeball {

struct ExposureAgreement {
  size_t longer, shorter;  // two exposures, by index
  double factor;           // of their green channels' exposures, as given
  // What was found instead, over what was given: the median over pixels for each channel; NaN for a
  // channel without enough pixels that both exposures show well.
  dvec3 found;
  size_t pixels = 0;  // in the channel that has the fewest

  // The largest difference of `found` from 1; nullopt if no channel has enough pixels.
  std::optional<double> error() const;
};

// For each exposure but the longest, with the next longer one. Pixels are compared where, by the
// longer one, it has at most 85% and the shorter one at least 1% of the exposure of white: a choice
// by the shorter one would prefer those that noise brightens.
std::vector<ExposureAgreement> exposureAgreement(std::span<const Exposure> exposures,
                                                 const ResponseCurve& response);

}  // namespace chromeball
