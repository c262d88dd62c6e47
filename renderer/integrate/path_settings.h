// SPDX-License-Identifier: Apache-2.0
// What limits paths, and what they can see.
#pragma once

#include "lighting/strategy.h"
#include "trace/ray.h"

namespace chromeball {

// Enough for every path through a few vessels, one behind another.
inline constexpr int kDefaultTransmissionDepth = 64;

struct PathSettings {
  Mis mis = Mis::Balance;
  int maxDepth = 8;  // 0: emission seen by the camera; 1: direct light; ...
  int maxTransmissionDepth = kDefaultTransmissionDepth;  // bounces in solid glass, beside maxDepth
  bool hideProbe = false;                                // from the camera
  bool estimateDepthCut = true;     // estimate what the limits of depth cut off
  RayMask visible = kAllInstances;  // the instances that exist for the paths
  // Where it differs from `visible`: shadow rays are traced there too, and
  // PathContext::shadowsDiffer reports where the two disagree.
  RayMask compared = visible;
};

}  // namespace chromeball
