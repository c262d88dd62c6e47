// SPDX-License-Identifier: Apache-2.0
#include "transport/depth_cut.h"

#include <climits>
#include <cmath>
#include <utility>

#include "transport/path.h"

namespace chromeball {

// Continues one in kInterval of the paths that reach a limit twice with the same random numbers:
// with the given limits, and with kExtraBounces more bounces. The difference is the light cut off.
[[gnu::noinline]] void PathTracer::followTwice(PathState& state, const Hit& hit,
                                               PathContext& context) const {
  constexpr uint32_t kInterval = 64;
  constexpr int kExtraBounces = 256;
  constexpr uint64_t kPurpose = 0x637574;  // separate random stream
  state.cutIsEstimated = true;
  if (hash(context.sampler.sampleKey(), kPurpose) % kInterval != 0) return;
  PathSettings limited = settings_;
  limited.estimateDepthCut = false;
  PathSettings farther = limited;
  farther.maxDepth = std::min(settings_.maxDepth, INT_MAX - kExtraBounces) + kExtraBounces;
  farther.maxTransmissionDepth =
      std::min(settings_.maxTransmissionDepth, INT_MAX - kExtraBounces) + kExtraBounces;

  PathState rest = state;
  rest.radiance = Rgb(0);
  rest.first = nullptr;
  rest.deferred = nullptr;
  const RayCounts counted = context.counts;
  const auto records = std::exchange(context.records, nullptr);
  const auto groups = std::exchange(context.groups, nullptr);
  const auto found = [&](const PathSettings& settings) {
    return luminance(PathTracer(world_, lighting_, settings).follow(rest, hit, context));
  };
  const float cut = found(farther) - found(limited);
  context.counts = counted;
  context.records = records;
  context.groups = groups;
  context.sampler.startVertex(state.depth);
  if (std::isfinite(cut))
    context.depthCut.add(state.bounces() == settings_.maxDepth, kInterval * cut);
}

void PathTracer::estimateDepthCut(PathState& state, const std::optional<Hit>& hit,
                                  PathContext& context) const {
  if (!settings_.estimateDepthCut || !hit || state.cutIsEstimated) return;
  if (state.bounces() == settings_.maxDepth ||
      state.transmissions == settings_.maxTransmissionDepth)
    followTwice(state, *hit, context);
}

}  // namespace chromeball
