// SPDX-License-Identifier: Apache-2.0
// Estimate of the energy lost to the depth limits of a render.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string_view>

#include "math/vec.h"

namespace chromeball {

// The limits of PathSettings; of those that a path reaches at once, the first here.
enum class DepthLimit { Depth, Diffuse, Specular, Transmission };

// In the order of DepthLimit.
inline constexpr std::array<std::string_view, 4> kDepthLimitNames = {
    "max_depth", "max_diffuse_depth", "max_specular_depth", "max_transmission_depth"};

// Sums of luminance over paths. `cut` are unbiased estimates of the light beyond the limit that a
// path reaches first, [DepthLimit], up to the number of extra bounces of
// PathTracer::estimateDepthCut().
struct DepthCut {
  static constexpr size_t kLimits = kDepthLimitNames.size();

  double found = 0;
  std::array<double, kLimits> cut{};

  void addFound(const Rgb& radiance) {
    if (isFinite(radiance)) found += double(luminance(radiance));
  }
  void add(DepthLimit limit, double luminance) { cut[size_t(limit)] += luminance; }
  void add(const DepthCut& other) {
    found += other.found;
    for (size_t i = 0; i < kLimits; ++i) cut[i] += other.cut[i];
  }

  // What a limit cut, as a fraction of all light, found and cut.
  double fraction(DepthLimit limit) const {
    const double part = cut[size_t(limit)];
    return part > 0 ? part / std::accumulate(cut.begin(), cut.end(), found) : 0;
  }
};

}  // namespace chromeball
