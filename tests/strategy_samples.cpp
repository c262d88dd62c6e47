// SPDX-License-Identifier: Apache-2.0
#include "strategy_samples.h"

namespace chromeball {

Samples::Samples(const LightSource& strategy, const vec3& normal, int depth)
    : strategy_(strategy), point_{{}, normal, nullptr, depth} {}

const std::vector<DirectionSample>& Samples::take(int i) {
  sampler_.startPixel(uint32_t(i), 0, 0);
  sampler_.startSample(0);
  sampler_.startVertex(0);
  samples_.clear();
  strategy_.sample(point_, sampler_, samples_);
  return samples_;
}

}  // namespace chromeball
