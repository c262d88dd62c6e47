// SPDX-License-Identifier: Apache-2.0
#include "study/report/sampled_directions.h"

#include <set>
#include <tuple>

namespace chromeball {

std::vector<vec3> sampledDirections(const LightSource& strategy) {
  constexpr uint32_t kSamples = 128;
  const SobolTable table(kSamples, dimension::kVertex + dimension::kPerVertex, 0);
  PixelSampler sampler(table, 0);
  sampler.startPixel(0, 0, 0);
  std::vector<DirectionSample> samples;
  for (uint32_t i = 0; i < kSamples; ++i) {
    sampler.startSample(i);
    sampler.startVertex(0);
    strategy.sample({vec3(0), vec3(0, 1, 0), nullptr, 0}, sampler, samples);
  }
  std::set<std::tuple<float, float, float>> seen;
  std::vector<vec3> directions;
  for (const DirectionSample& sample : samples)
    if (seen.insert({sample.wi.x, sample.wi.y, sample.wi.z}).second)
      directions.push_back(sample.wi);
  return directions;
}

}  // namespace chromeball
