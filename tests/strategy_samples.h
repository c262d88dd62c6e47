// SPDX-License-Identifier: Apache-2.0
// Takes samples of a lighting strategy.
#pragma once

#include <vector>

#include "lighting/strategy.h"

namespace chromeball {

// Independent samples at one point: the first hit, or a later one.
class Samples {
 public:
  Samples(const LightSource& strategy, const vec3& normal, int depth = 0);

  const std::vector<DirectionSample>& take(int i);
  const LightPoint& point() const { return point_; }

 private:
  const LightSource& strategy_;
  LightPoint point_;
  SobolTable table_{1, 16, 5};
  PixelSampler sampler_{table_, 7};
  std::vector<DirectionSample> samples_;
};

}  // namespace chromeball
