// SPDX-License-Identifier: Apache-2.0
#include "transport/scene_light_lanes.h"

#include <algorithm>
#include <limits>

#include "transport/path.h"
#include "transport/path_lanes.h"

namespace chromeball {
namespace {

using L = LanesOf<Float8>;
using Vector = Lanes3<Float8>;

}  // namespace

// Light samples need the BSDF's own normal, which differs from the surface's where that would
// reflect the viewer's direction below the surface.
void SceneLightLanes::draw(const LaneTask& task, const PathArrays& paths, int depth, size_t i,
                           const VertexArrays& vertices, const Vector& normal) {
  samples_.clear();
  for (size_t k = 0; k < kLanes; ++k) {
    begins_[k] = samples_.size();
    if (i + k >= paths.size || vertices.isHidden[i + k]) continue;
    PixelSampler& sampler = task.context.sampler;
    sampler.startSample(task.cameras.numbers(size_t(paths.id[i + k])));
    sampler.startVertex(depth);
    const LightPoint point{
        vertices.position.at(i + k), {normal.x[k], normal.y[k], normal.z[k]}, nullptr, depth};
    for (const auto& source : task.world().sources.all) source->sample(point, sampler, samples_);
  }
  begins_[kLanes] = samples_.size();
}

void SceneLightLanes::scatter(const LaneTask& task, const PathArrays& paths, int depth, size_t i,
                              const VertexArrays& vertices, const GuidedBsdfLanes& bsdf,
                              const Vector& normal, const Vector& throughput) {
  draw(task, paths, depth, i, vertices, normal);
  size_t most = 0;
  for (size_t k = 0; k < kLanes; ++k) most = std::max(most, begins_[k + 1] - begins_[k]);
  for (size_t j = 0; j < most; ++j) {  // sample j of each vertex
    LaneArrays3 direction, light;
    alignas(64) LaneArray<float> pdf;
    const auto sampleOf = [&](size_t k) -> const DirectionSample* {
      const size_t at = begins_[k] + j;
      return at < begins_[k + 1] ? &samples_[at] : nullptr;
    };
    for (size_t k = 0; k < kLanes; ++k) {
      const DirectionSample* const sample = sampleOf(k);
      direction.set(k, sample ? sample->wi : vec3(0, 1, 0));
      light.set(k, sample ? sample->irradiance : Rgb(0));
      // The MIS weight of a delta is 1.
      pdf[k] = !sample ? 0 : sample->isDelta ? std::numeric_limits<float>::infinity() : sample->pdf;
    }
    const BsdfLanesValue value = bsdf.evaluate(direction.load(0));
    const Float8 weight =
        weightOfLightSample(task.settings().mis, loadLanes(pdf.data()), value.pdf);
    LaneArrays3 radiance;
    radiance.store(0, throughput * (weight * value.fCos) * light.load(0));
    const unsigned lit = bitsOf((loadLanes(pdf.data()) > 0) & ~isBlack(value.fCos));
    forBits(lit, [&](unsigned k) {
      const DirectionSample& sample = *sampleOf(k);
      const bool isSurface = sample.end.instance != LightEnd::kNone;
      if (isSurface && !(sample.distance > vertices.rayOffset[i + k])) return;
      Ray ray = vertices.rayFrom(i + k, sample.wi, sample.distance);
      if (isSurface) ray.endAt(sample.end.position);
      shadows_.push_back({paths.id[i + k], uint32_t(i + k), radiance.at(k), sample.end});
      rays_.push_back(ray);
    });
  }
}

void SceneLightLanes::trace(const LaneTask& task, std::span<const uint32_t> keys) {
  const RayMask visible = task.settings().visible;
  task.context.counts.shadow += rays_.size();
  transmittances_.resize(rays_.size());
  task.world().accel.transmittance(rays_, transmittances_, visible);
  for (size_t i = 0; i < shadows_.size(); ++i) {
    const Shadow& shadow = shadows_[i];
    if (isBlack(transmittances_[i])) continue;
    task.radiances[size_t(shadow.id)] +=
        shadow.radiance * task.tracer.direct().throughEnd(transmittances_[i], rays_[i], {}, visible,
                                                          keys[shadow.vertex], shadow.end);
  }
}

}  // namespace chromeball
