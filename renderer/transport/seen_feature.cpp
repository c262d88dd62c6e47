// SPDX-License-Identifier: Apache-2.0
#include "transport/seen_feature.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/cdf.h"
#include "math/warp.h"
#include "transport/path.h"

namespace chromeball {
namespace {

float medianLuminance(const SceneSources& sources, const LightSource& lighting) {
  constexpr int kSide = 16;
  std::vector<float> luminances;
  for (int i = 0; i < kSide * kSide; ++i) {
    const vec2 u((float(i % kSide) + 0.5f) / kSide, (float(i / kSide) + 0.5f) / kSide);
    const vec3 direction = squareToUniformSphere(u);
    Rgb radiance = lighting.background(vec3(0), direction);
    for (const size_t s : sources.distant) radiance += sources.all[s]->background({}, direction);
    luminances.push_back(luminance(radiance));
  }
  const float middle = median(std::move(luminances));
  return middle > 0 && std::isfinite(middle) ? middle : 1;
}

bool isSeen(const PathState& state) { return state.lobes == Lobes::Narrow && !state.first->direct; }

}  // namespace

SeenFeature::SeenFeature(const World& world, const LightSource& lighting)
    : median_(medianLuminance(world.sources, lighting)) {}

void SeenFeature::noteEscaped(const PathState& state, const Rgb& escaped) const {
  if (isSeen(state) && state.depth > 0) state.first->seen = escaped / (escaped + median_);
}

void SeenFeature::noteSurface(const PathState& state, const MaterialPoint& material) {
  if (isSeen(state)) state.first->seen = glm::min(state.throughput * material.baseColor, 1.0f);
}

}  // namespace chromeball
