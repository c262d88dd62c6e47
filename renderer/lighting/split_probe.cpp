// SPDX-License-Identifier: Apache-2.0
#include "lighting/split_probe.h"

namespace chromeball {

SplitProbe::SplitProbe(std::unique_ptr<LightSource> strategy, const Probe& probe)
    : SplitProbe(std::move(strategy), extractSuns(probe.latLong()), probe.rotation()) {}

SplitProbe::SplitProbe(std::unique_ptr<LightSource> strategy, const SunExtraction& extraction,
                       const Rotation& rotation)
    : strategy_(std::move(strategy)),
      hasSuns_(!extraction.suns.empty()),
      rest_(extraction.remainder, rotation) {}

std::vector<std::string> SplitProbe::groups() const {
  if (!hasSuns_) return {"rest"};
  return {"suns", "rest"};
}

// The rest is at most the whole: rounding leaves no negative suns.
void SplitProbe::split(const Rgb& whole, const vec3& wi, std::span<Rgb> radiances) const {
  const Rgb rest = hasSuns_ ? glm::min(rest_.radiance(wi), whole) : whole;
  radiances.back() += rest;
  if (hasSuns_) radiances.front() += whole - rest;
}

}  // namespace chromeball
