// SPDX-License-Identifier: Apache-2.0
// Ways of sampling the light of a probe, by name.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lighting/light_source.h"
#include "probe/probe.h"

namespace chromeball {

// The heuristic that weights light samples and BSDF samples (Veach 1997).
enum class Mis { Off, Balance, Power };

struct StrategyOptions {
  Mis mis;
  std::optional<double> sunAngle;  // diameter of the strategy suns' discs, degrees; else measured
  // With strategies that replace the probe by lights, the camera and mirrors see these lights, as
  // discs of at least a degree, instead of the probe.
  bool showLights = false;

  StrategyOptions(Mis m = Mis::Balance, std::optional<double> angle = {}, bool show = false)
      : mis(m), sunAngle(angle), showLights(show) {}
};

// Makes a strategy from its name on the command line, "NAME" or "NAME:COUNT"; "auto" is the
// unbiased strategy that is best for most scenes. The probe must outlive the strategy. Throws
// InputError for an unknown name, with a message that begins with `location` (an option, or
// FILE:LINE).
std::unique_ptr<LightSource> makeStrategy(const std::string& name, const Probe& probe,
                                          const StrategyOptions& options,
                                          const std::string& location);

// Replaces "auto" by a strategy, and appends the default count if none is given.
std::string resolveStrategy(const std::string& name);

// Whether a strategy, "NAME" or "NAME:COUNT", replaces the probe by lights, so that there are
// lights to show. True for an unknown name, which makeStrategy() refuses.
bool hasLights(const std::string& name);

// Every name but "auto", without counts.
std::vector<std::string_view> strategyNames();

}  // namespace chromeball
