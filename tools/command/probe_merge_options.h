// SPDX-License-Identifier: Apache-2.0
// The options of `chromeball probe merge`.
#pragma once

#include "command.h"

#include "probe/capture/merge_photographs.h"

namespace chromeball {

struct MergeArguments {
  std::vector<std::string> files, ratios, filters, flatFields, calibration;
  std::string output, exposures, apertures, response, responseOutput, smoothness, white;
  bool unaligned = false, resizes = false, json = false;

  void addTo(Command command);

  // Throws InputError for options that are for a series, not for the calibration of a filter.
  void checkCalibration() const;

  // Converts the options, without looking at files. Throws InputError.
  PhotographSeries series() const;
};

}  // namespace chromeball
