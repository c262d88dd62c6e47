// SPDX-License-Identifier: Apache-2.0
#include "transport/depth_cut.h"

#include <climits>
#include <cmath>
#include <utility>

#include "transport/path.h"

namespace chromeball {
namespace {

constexpr int kExtraBounces = 256;

int raisedLimit(int limit) { return std::min(limit, INT_MAX - kExtraBounces) + kExtraBounces; }

// More paths reach the limits by kind, and earlier, than the others.
constexpr uint32_t intervalOf(DepthLimit limit) {
  return limit == DepthLimit::Diffuse || limit == DepthLimit::Specular ? 256 : 64;
}

// Whether limits of bounces by kind may leave lobes of the material out. The kind that makes up for
// multiple scattering of metal, which is diffuse, does not count.
bool mayBeDiffuse(const Material& m) {
  return !m.isBody() &&
         (m.metallic < 1 || m.metallicRoughnessTexture || m.specularGlossiness || m.extended);
}
bool mayBeSpecular(const Material& m) {
  return !m.isBody() && (m.specular > 0 || m.metallic > 0 || m.extended);
}

}  // namespace

// The limit at which the path loses what its next surface scatters, or some of it.
std::optional<DepthLimit> PathTracer::reachedLimit(const PathState& state, const Hit& hit) const {
  if (state.bounces() == settings_.maxDepth) return DepthLimit::Depth;
  const Scene& scene = world_.scene;
  const auto material = [&]() -> const Material& {
    return scene.materials[size_t(scene.instances[hit.instance].material)];
  };
  if (limitsKinds_) [[unlikely]] {
    if (state.diffuse == settings_.maxDiffuseDepth && mayBeDiffuse(material()))
      return DepthLimit::Diffuse;
    if (state.specular == settings_.maxSpecularDepth && mayBeSpecular(material()))
      return DepthLimit::Specular;
  }
  if (state.transmissions == settings_.maxTransmissionDepth && material().isBody())
    return DepthLimit::Transmission;
  return {};
}

bool PathTracer::limitKinds(const PathState& state, Bsdf& bsdf) const {
  const KeptLobes kept{state.diffuse < settings_.maxDiffuseDepth,
                       state.specular < settings_.maxSpecularDepth};
  if (!kept.diffuse || !kept.specular) bsdf.keepOnly(kept);
  return kept.diffuse || kept.specular;
}

bool PathTracer::isFollowed(DepthLimit limit, uint32_t key) {
  constexpr uint64_t kPurpose = 0x637574;  // separate random stream
  return hash(key, kPurpose) % intervalOf(limit) == 0;
}

// Continues one in intervalOf() of the paths that reach a limit twice with the same random numbers:
// with the given limits, and with kExtraBounces more bounces. The difference is the light cut off.
[[gnu::noinline]] void PathTracer::followTwice(PathState& state, const Hit& hit, DepthLimit limit,
                                               PathContext& context) const {
  state.cutIsEstimated = true;
  if (!isFollowed(limit, context.sampler.sampleKey())) return;
  PathSettings limited = settings_;
  limited.estimateDepthCut = false;
  PathSettings farther = limited;
  for (int PathSettings::*depth : {&PathSettings::maxDepth, &PathSettings::maxTransmissionDepth,
                                   &PathSettings::maxDiffuseDepth, &PathSettings::maxSpecularDepth})
    farther.*depth = raisedLimit(settings_.*depth);

  PathState rest = state;
  rest.radiance = Rgb(0);
  rest.first = nullptr;
  rest.deferred = nullptr;
  const RayCounts counted = context.counts;
  const auto records = std::exchange(context.records, nullptr);
  const auto groups = std::exchange(context.groups, nullptr);
  const auto found = [&](const PathSettings& settings) {
    return luminance(PathTracer(*this, settings).follow(rest, hit, context));
  };
  const float cut = found(farther) - found(limited);
  context.counts = counted;
  context.records = records;
  context.groups = groups;
  context.sampler.startVertex(state.depth);
  if (std::isfinite(cut)) context.depthCut.add(limit, intervalOf(limit) * cut);
}

void PathTracer::estimateDepthCut(PathState& state, const std::optional<Hit>& hit,
                                  PathContext& context) const {
  if (!settings_.estimateDepthCut || !hit || state.cutIsEstimated) return;
  if (const auto limit = reachedLimit(state, *hit)) followTwice(state, *hit, *limit, context);
}

}  // namespace chromeball
