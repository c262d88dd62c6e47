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

  // Converts the options, without looking at files. Throws InputError.
  PhotographSeries series() const;
};

}  // namespace chromeball
