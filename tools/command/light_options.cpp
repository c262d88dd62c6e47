// SPDX-License-Identifier: Apache-2.0
#include "light_options.h"

#include "base/suggest.h"
#include "messages.h"
#include "probe/edit.h"

namespace chromeball {

void LightsProbe::checkMask() const {
  if (mask != "none" && mask != "below-horizon")
    throwInput("--probe-mask: unknown mask `{}`; {}", mask,
               didYouMean(mask, {"none", "below-horizon"}));
}

LoadedProbe LightsProbe::loadWithFile() const {
  LoadedProbe probe = loadProbe(file, mapping, "--mapping");
  for (const std::string& warning : warnings(probe, file)) warn(warning);
  if (mask == "below-horizon") replaceBelowHorizon(probe.latLong, Rgb(0));
  return probe;
}

}  // namespace chromeball
