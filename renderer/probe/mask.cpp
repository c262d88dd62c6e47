// SPDX-License-Identifier: Apache-2.0
#include "probe/mask.h"

#include <algorithm>

#include "base/error.h"
#include "base/suggest.h"

namespace chromeball {

ProbeMask parseProbeMask(std::string_view name, std::string_view location) {
  if (name == "none") return ProbeMask::None;
  if (name == "below-horizon") return ProbeMask::BelowHorizon;
  throwInput("{}: unknown mask `{}`; {}", location, name,
             didYouMean(name, {"none", "below-horizon"}));
}

void applyMask(ProbeMask mask, Image& latLong) {
  if (mask == ProbeMask::None) return;
  const size_t row = size_t(latLong.width) * latLong.channels;
  const auto horizon = latLong.texels.begin() + row * (latLong.height / 2);
  auto below = horizon;
  if (latLong.height % 2) {
    below += row;
    std::for_each(horizon, below, [](float& radiance) { radiance *= 0.5f; });
  }
  std::fill(below, latLong.texels.end(), 0.0f);
}

}  // namespace chromeball
