// SPDX-License-Identifier: Apache-2.0
#include "transport/wide_paths.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "transport/camera_samples.h"
#include "transport/first_surface.h"
#include "transport/path_lanes.h"

namespace chromeball {
namespace {

using L = LanesOf<Float8>;
using Vector = Lanes3<Float8>;

}  // namespace

bool WidePaths::serves(const PathTracer& tracer, const PathContext& context) {
  const World& world = tracer.world();
  const PathSettings& s = tracer.settings();
  return world.plain.any() && !world.scene.moves && world.sources.distant.empty() &&
         tracer.mirrorAlpha() == 0 && tracer.lighting().sampleMany({}, {}) && s.maxDepth > 0 &&
         !s.limitsKinds() && s.compared == s.visible && (!s.guide || s.guide->empty()) &&
         !context.groups && !context.log;
}

void WidePaths::start(const LaneTask& task) {
  depth_ = 0;
  left_.clear();
  for (PathArrays* const paths : {paths_, next_, &escaped_})
    paths->keepsVertices = task.context.records || !task.world().sources.all.empty();
  PathArrays& paths = *paths_;
  paths.size = task.cameras.size();
  std::fill_n(task.radiances.begin(), paths.size, Rgb(0));
  const CameraSamples::Group& cameras = task.cameras.group(0);
  paths.rays = cameras.rays, paths.hits = cameras.hits, paths.widening = cameras.widening;
  for (LaneArray<float>* const one :
       {&paths.throughput.x, &paths.throughput.y, &paths.throughput.z})
    one->fill(1);
  for (LaneArray<float>* const zero : {&paths.pdf, &paths.length, &paths.minAlpha}) zero->fill(0);
  paths.scattered.fill(0);
  std::iota(paths.id.begin(), paths.id.end(), 0);
  guided_.ratio.fill(1);
  if (task.context.records) std::fill_n(guided_.bounces.begin(), paths.size, GuidedBounce{});
}

void WidePaths::trace(const CameraSamples& cameras, const PathTracer& tracer, PathContext& context,
                      PathBatch& rest, std::span<Rgb> radiances) {
  const LaneTask task{cameras, tracer, context, radiances, guided_};
  rest_ = &rest;
  start(task);
  follow(task);
  for (size_t id = 0; context.records && id < cameras.size(); ++id)
    context.addRecord(guided_.bounces[id], radiances[id]);
}

void WidePaths::follow(const LaneTask& task) {
  for (;;) {
    endEscaped(task);
    if (depth_ == task.settings().maxDepth) return endAtLimit(task);
    leaveLanes(task);
    if (paths_->size == 0) return;
    scatter_.fillVertices(task, *paths_);
    leaveHidden(task);
    addEmission(task);
    noteFirst(task);
    setKeys(task);
    scatter_.scatter(task, *paths_, keys_, depth_, *next_);
    ++depth_;
    std::swap(paths_, next_);
    if (depth_ == task.settings().maxDepth && task.tracer.surfacesEndPaths())
      traceLastRays(task);
    else
      traceRays(task);
  }
}

void WidePaths::setKeys(const LaneTask& task) {
  for (size_t k = 0; k < paths_->size; ++k)
    keys_[k] = PixelSampler::vertexKey(task.cameras.numbers(size_t(paths_->id[k])), depth_);
}

void WidePaths::traceRays(const LaneTask& task) {
  setKeys(task);
  task.world().accel.intersect(paths_->rays, paths_->size, std::span(keys_).first(paths_->size),
                               Accel::Coherence::None, paths_->hits, task.settings().visible);
}

// As PathTracer::endsAtAnyHit().
void WidePaths::traceLastRays(const LaneTask& task) {
  setKeys(task);
  const Accel& accel = task.world().accel;
  const RayMask visible = task.settings().visible;
  accel.transmittance(paths_->rays, std::span(transmittances_).first(paths_->size), visible);
  paths_->removeIf([&](size_t i, unsigned here) {
    unsigned gone = 0;
    forBits(here, [&](unsigned lane) {
      const size_t k = i + lane;
      paths_->hits.instance[k] = HitArrays::kNone;
      if (!isBlack(transmittances_[k])) return;
      const bool isMirrored = paths_->pdf[k] == 0;  // mirrors do not see all backs
      if (!isFollowed(task, k) && !isMirrored) {
        gone |= 1u << lane;
        return;
      }
      Hit hit;
      const Ray ray{paths_->rays.origin.at(k), paths_->rays.direction.at(k)};
      if (accel.intersect(ray, keys_[k], hit, visible)) paths_->hits.set(k, hit);
    });
    return gone;
  });
}

// Whether the light beyond the limit of depth is estimated by this path.
bool WidePaths::isFollowed(const LaneTask& task, size_t path) const {
  return task.settings().estimateDepthCut && PathTracer::isFollowed(DepthLimit::Depth, keys_[path]);
}

void WidePaths::endAtLimit(const LaneTask& task) {
  setKeys(task);
  for (size_t k = 0; k < paths_->size; ++k) {
    const PlainSurfaces::Part& part = partOf(task, k);
    const bool mayBeHidden = part.hidesBack && paths_->pdf[k] == 0;
    if (isNotForLanes(task, k) || part.emits || mayBeHidden || isFollowed(task, k))
      handOver(task, k);
  }
}

const PlainSurfaces::Part& WidePaths::partOf(const LaneTask& task, size_t path) const {
  return task.world().plain.part(size_t(paths_->hits.instance[path]));
}

bool WidePaths::isNotForLanes(const LaneTask& task, size_t path) const {
  const HitArrays& hits = paths_->hits;
  return partOf(task, path).kind == PlainSurfaces::Kind::Other ||
         task.world().sharedPlaces.contains(uint32_t(hits.instance[path]),
                                            uint32_t(hits.triangle[path]));
}

// Paths whose first hit notes what is seen in smooth mirrors leave the lanes there.
bool WidePaths::notesMirrored(const LaneTask& task, size_t path) const {
  return depth_ > 0 && paths_->pdf[path] == 0 && task.cameras.first(size_t(paths_->id[path]));
}

void WidePaths::leaveLanes(const LaneTask& task) {
  paths_->removeIf([&](size_t i, unsigned here) {
    unsigned gone = 0;
    forBits(here, [&](unsigned lane) {
      if (!isNotForLanes(task, i + lane) && !notesMirrored(task, i + lane)) return;
      handOver(task, i + lane);
      gone |= 1u << lane;
    });
    return gone;
  });
}

void WidePaths::handOver(const LaneTask& task, size_t k) {
  const size_t id = size_t(paths_->id[k]);
  const CameraSample camera = task.cameras[id];
  PathState state = camera.path();
  state.ray.origin = paths_->rays.origin.at(k), state.ray.direction = paths_->rays.direction.at(k);
  state.radiance = task.radiances[id];
  state.throughput = paths_->throughput.at(k);
  state.from = {state.ray.origin, state.ray.direction, nullptr, depth_ - 1};
  if (paths_->keepsVertices && depth_ > 0) {
    state.from.position = paths_->position.at(k), state.from.normal = paths_->normal.at(k);
    state.throughputBefore = paths_->throughputBefore.at(k);
  }
  state.pdf = paths_->pdf[k];
  state.isDelta = state.pdf == 0;
  state.lobes = state.isDelta ? Lobes::Narrow : Lobes::Broad;
  state.depth = depth_;
  state.scattered = paths_->scattered[k] != 0;
  state.minAlpha = paths_->minAlpha[k];
  state.length = paths_->length[k];
  state.guideRatio = guided_.ratio[id];
  state.guided = std::exchange(guided_.bounces[id], {});
  rest_->add(camera, state, paths_->hits.at(k));
  left_.push_back(uint32_t(id));
}

void WidePaths::endEscaped(const LaneTask& task) {
  escaped_.size = 0;
  paths_->removeIf([&](size_t i, unsigned here) {
    const unsigned gone = here & bitsOf(loadLanes(&paths_->hits.instance[i]) == HitArrays::kNone);
    unsigned escaped = gone;
    forBits(gone, [&](unsigned lane) {
      if (!notesMirrored(task, i + lane)) return;
      handOver(task, i + lane);
      escaped &= ~(1u << lane);
    });
    escaped_.add(*paths_, i, LanePacking(escaped));
    return gone;
  });
  const bool isSeen = depth_ == 0;
  if (escaped_.size == 0 || (isSeen && task.settings().hideProbe)) return;
  if (isSeen)
    task.lighting().backgroundArrays(escaped_.rays, escaped_.size, found_);
  else
    task.lighting().escapedArrays(escaped_.rays, escaped_.size, found_);
  addEscaped(task);
}

// As PathTracer::addBackground() and addEscaped(). All of the probe's light is found by cameras and
// smooth mirrors.
void WidePaths::addEscaped(const LaneTask& task) {
  LaneArrays3 found, weighted;
  for (size_t i = 0; i < escaped_.size; i += kLanes) {
    const Float8 pdf = loadLanes(&escaped_.pdf[i]);
    const Vector light = escaped_.throughput.load(i) * found_.light.load(i);
    const Float8 weight = weightOfBsdfSample(task.settings().mis, pdf, loadLanes(&found_.pdf[i]));
    found.store(i, light);
    weighted.store(i, chosen(pdf == 0, light, weight * light));
  }
  for (size_t k = 0; k < escaped_.size; ++k) {
    task.radiances[size_t(escaped_.id[k])] += weighted.at(k);
    if (task.context.records && escaped_.pdf[k] != 0)
      task.context.addRecord(recordOf(k, found.at(k), found_.pdf[k]));
  }
}

// As in PathTracer::weighted().
LightRecord WidePaths::recordOf(size_t k, const Rgb& found, float lightPdf) const {
  const float pdf = escaped_.pdf[k];
  const float integrand = luminance(found) / luminance(escaped_.throughputBefore.at(k)) * pdf;
  return {escaped_.position.at(k),
          escaped_.normal.at(k),
          escaped_.rays.direction.at(k),
          integrand,
          lightPdf + pdf,
          lightPdf,
          pdf};
}

void WidePaths::leaveHidden(const LaneTask& task) {
  for (size_t k = 0; k < paths_->size; ++k) {
    if (isHidden(k)) [[unlikely]]
      handOver(task, k);
    paths_->length[k] += paths_->hits.distance[k];
  }
}

// As PathTracer::foundEmission().
void WidePaths::addEmission(const LaneTask& task) {
  if (!task.world().plain.anyEmits()) return;
  for (size_t k = 0; k < paths_->size; ++k) {
    if (!partOf(task, k).emits || isHidden(k)) continue;
    const LightPoint from{paths_->position.at(k), paths_->normal.at(k), nullptr, depth_ - 1};
    task.radiances[size_t(paths_->id[k])] +=
        paths_->throughput.at(k) *
        task.tracer.foundEmission(from, paths_->pdf[k], paths_->rays.direction.at(k),
                                  scatter_.vertices().surface(k), *paths_->hits.at(k));
  }
}

void WidePaths::noteFirst(const LaneTask& task) {
  for (size_t k = 0; k < paths_->size; ++k) {
    const size_t id = size_t(paths_->id[k]);
    FirstHit* const first = task.cameras.first(id);
    if (!first || isHidden(k)) continue;
    if (depth_ > 0) {
      if (!first->direct) first->direct = task.radiances[id];
      continue;
    }
    const Instance& instance = task.world().scene.instances[size_t(paths_->hits.instance[k])];
    *first = firstHitAt(instance, scatter_.vertices().normal.at(k),
                        scatter_.vertices().baseColor.at(k), paths_->length[k]);
  }
}

}  // namespace chromeball
