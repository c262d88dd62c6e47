// SPDX-License-Identifier: Apache-2.0
// An optional upper bound on the radiance of a sample (`clamp`). The bias is measured and reported.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "math/vec.h"

namespace chromeball {

// Number of clamped samples, and the energy removed from them.
struct ClampedSamples {
  uint64_t count = 0;
  double removed = 0, kept = 0;  // sums over samples of (absolute) luminance

  double fractionRemoved() const { return removed > 0 ? removed / (removed + kept) : 0; }
  void add(const ClampedSamples& other) {
    count += other.count, removed += other.removed, kept += other.kept;
  }
};

class Clamp {
 public:
  explicit Clamp(std::optional<float> limit = {}) : limit_(limit) {}

  // The radiance (or difference of radiances) scaled so that no channel exceeds the limit in
  // absolute value; the hue stays. Non-finite values pass unchanged, to be counted as invalid.
  Rgb operator()(const Rgb& radiance) {
    if (!limit_ || !isFinite(radiance)) return radiance;
    const float largest = maxComponent(absolute(radiance));
    const float scale = largest > *limit_ ? *limit_ / largest : 1;
    const double light = std::fabs(double(luminance(radiance)));
    clamped_.kept += light * scale;
    if (scale == 1) return radiance;
    ++clamped_.count;
    clamped_.removed += light * (1 - double(scale));
    return radiance * scale;
  }

  const ClampedSamples& clamped() const { return clamped_; }
  ClampedSamples takeClamped() { return std::exchange(clamped_, {}); }

 private:
  std::optional<float> limit_;
  ClampedSamples clamped_;
};

}  // namespace chromeball
