// SPDX-License-Identifier: Apache-2.0
#include "transport/integrator.h"

#include <algorithm>
#include <new>

#include "transport/camera_samples.h"
#include "transport/light_groups.h"
#include "transport/wide_paths.h"

namespace chromeball {

void SingleIntegrator::sampleMany(const CameraSamples& cameras, PathContext& context,
                                  std::span<Sample> samples) const {
  for (size_t i = 0; i < cameras.size(); ++i) {
    const CameraSample camera = cameras[i];
    camera.start(context.sampler);
    samples[i] = sample(camera, context);
  }
}

void PathIntegrator::sampleMany(const CameraSamples& cameras, PathContext& context,
                                std::span<Sample> samples) const {
  const std::span<const Rgb> radiances = PathBatch::traced(cameras, tracer_, context);
  for (size_t i = 0; i < cameras.size(); ++i) samples[i] = context.clamp(radiances[i]);
}

size_t Integrator::batch() const { return PathBatch::kMaxPaths; }

size_t PathIntegrator::batch() const {
  return std::max(PathBatch::kMaxPaths, tracer_.lighting().batch());
}

struct PathBatch::Task {
  const PathTracer& tracer;
  PathContext& context;

  const LightSource& lighting() const { return tracer.lighting(); }
  const Scene& scene() const { return tracer.world().scene; }
  const Accel& accel() const { return tracer.world().accel; }
  RayMask visible() const { return tracer.settings().visible; }
};

std::span<const Rgb> PathBatch::traced(const CameraSamples& cameras, const PathTracer& tracer,
                                       PathContext& context) {
  thread_local PathBatch batch;
  thread_local WidePaths wide;
  thread_local std::vector<Rgb> radiances;
  radiances.resize(std::max(cameras.size(), radiances.size()));
  batch.clear();
  context.counts.camera += cameras.size();
  if (cameras.size() <= WidePaths::kMaxPaths && WidePaths::serves(tracer, context)) {
    wide.trace(cameras, tracer, context, batch, radiances);
    batch.follow(tracer, context);
    for (size_t k = 0; k < wide.left().size(); ++k) radiances[wide.left()[k]] = batch.radiance(k);
  } else {
    for (size_t i = 0; i < cameras.size(); ++i) batch.add(cameras[i]);
    batch.follow(tracer, context);
    for (size_t i = 0; i < cameras.size(); ++i) radiances[i] = batch.radiance(i);
  }
  const auto found = std::span<const Rgb>(radiances).first(cameras.size());
  for (const Rgb& radiance : found) context.depthCut.addFound(radiance);
  return found;
}

void PathBatch::add(const CameraSample& camera, const PathState& state,
                    const std::optional<Hit>& hit) {
  if (count_ == paths_.size()) grow();
  new (&paths_[count_]) PathState(state);  // in place, for a state is large
  cameras_[count_] = {camera.numbers, camera.layers};
  hits_[count_] = hit;
  ++count_;
}

void PathBatch::grow() {
  const size_t size = std::max(kMaxPaths, 2 * paths_.size());
  const auto resize = [size](auto&... all) { (all.resize(size), ...); };
  resize(paths_, cameras_, hits_, lights_, escaped_, backgrounds_, samples_, found_,
         transmittances_);
  const auto resizeLists = [size](auto&... all) { (all.items.resize(size), ...); };
  resizeLists(active_, shaded_, chosen_, rays_, keys_, escapes_, sights_, numbers_, points_);
}

void PathBatch::follow(const PathTracer& tracer, PathContext& context) {
  Task task{tracer, context};
  active_.size = 0;
  for (size_t i = 0; i < count_; ++i) active_.add(uint32_t(i));
  while (active_.size) {
    endEscaped(task);
    drawLightSamples(task);
    shade(task);
    drawWaiting(task);
    completeGuided(task);
    traceShadowRays(task);
    traceNextRays(task);
  }
  for (size_t i = 0; i < count_; ++i) context.addRecord(paths_[i].guided, paths_[i].radiance);
}

// The sampler continues with the numbers for the path's next vertex, and light groups with its
// sums.
void PathBatch::select(uint32_t path, Task& task) {
  task.context.sampler.startSample(cameras_[path].numbers);
  task.context.sampler.startVertex(paths_[path].depth);
  selectGroups(path, task);
}

void PathBatch::selectGroups(uint32_t path, Task& task) {
  if (task.context.groups) [[unlikely]]
    task.context.groups->select(path, cameras_[path].layers);
}

void PathBatch::endEscaped(Task& task) {
  Indices& escaped = shaded_;  // not in use yet
  Indices& seen = chosen_;     // by narrow lobes and the camera
  escapes_.size = sights_.size = escaped.size = seen.size = 0;
  size_t remaining = 0;
  for (const uint32_t i : active_.all()) {
    PathState& path = paths_[i];
    if (hits_[i]) {
      active_.items[remaining++] = i;
    } else if (path.lobes == Lobes::Narrow) {
      seen.add(i);
      sights_.add({path.ray.origin, path.ray.direction});
    } else {
      escaped.add(i);
      escapes_.add({&path.from, path.ray.direction});
    }
  }
  active_.size = remaining;
  task.lighting().backgroundMany(sights_.all(), backgrounds_);
  for (size_t k = 0; k < seen.size; ++k) {
    selectGroups(seen.items[k], task);
    task.tracer.addBackground(paths_[seen.items[k]], backgrounds_[k], task.context);
  }
  task.lighting().escapedMany(escapes_.all(), escaped_);
  for (size_t k = 0; k < escaped.size; ++k) {
    selectGroups(escaped.items[k], task);
    task.tracer.addEscaped(paths_[escaped.items[k]], escaped_[k], task.context);
  }
}

void PathBatch::drawLightSamples(Task& task) {
  numbers_.size = 0;
  for (const uint32_t i : active_.all()) {
    const Hit& hit = *hits_[i];
    prefetchTriangle(task.scene(), task.scene().instances[hit.instance], hit.triangle);
    select(i, task);
    const PixelSampler& sampler = task.context.sampler;
    numbers_.add({sampler.bits(dimension::kLight), sampler.bits(dimension::kLight + 1)});
  }
  const bool takesOne = task.lighting().takesOneSample();
  const bool waits = task.lighting().batch() > 0;
  const bool drawn = !waits && task.lighting().sampleMany(numbers_.all(),
                                                          std::span(samples_).first(numbers_.size));
  for (size_t k = 0; k < active_.size; ++k) {
    const uint32_t i = active_.items[k];
    const Hit& hit = *hits_[i];
    prefetchVertices(task.scene(), task.scene().instances[hit.instance], hit.triangle);
    lights_[i].hasShadowRay = false;
    lights_[i].region = nullptr;
    lights_[i].isDrawn = drawn;
    lights_[i].waits = waits;
    lights_[i].waiting.reset();
    lights_[i].sample = samples_[k];
    paths_[i].deferred = takesOne ? &lights_[i] : nullptr;
  }
}

void PathBatch::shade(Task& task) {
  std::swap(shaded_, active_);
  active_.size = 0;
  for (const uint32_t i : shaded_.all()) {
    select(i, task);
    task.tracer.estimateDepthCut(paths_[i], hits_[i], task.context);
    if (task.tracer.vertex(paths_[i], hits_[i], task.context)) active_.add(i);
  }
}

// numbers_ are in the order of shaded_.
void PathBatch::drawWaiting(Task& task) {
  if (task.lighting().batch() == 0) [[likely]]
    return;
  chosen_.size = points_.size = numbers_.size = 0;
  for (size_t k = 0; k < shaded_.size; ++k) {
    const uint32_t i = shaded_.items[k];
    if (!lights_[i].waiting) continue;
    chosen_.add(i);
    points_.add(lights_[i].waiting->point);
    numbers_.add(numbers_.items[k]);
  }
  task.lighting().sampleAt(points_.all(), numbers_.all(), std::span(samples_).first(chosen_.size));
  for (size_t k = 0; k < chosen_.size; ++k) {
    const uint32_t i = chosen_.items[k];
    lights_[i].sample = samples_[k];
    selectGroups(i, task);
    task.tracer.direct().completeWaiting(lights_[i], task.context);
  }
}

void PathBatch::completeGuided(Task& task) {
  const LightGuide* guide = task.tracer.settings().guide;
  if (!guide || guide->empty()) return;
  Indices& guided = chosen_;
  escapes_.size = guided.size = 0;
  for (const uint32_t i : shaded_.all())
    if (lights_[i].region) {
      guided.add(i);
      escapes_.add({&lights_[i].point, lights_[i].shadowRay.direction});
    }
  task.lighting().escapedMany(escapes_.all(), escaped_);
  for (size_t k = 0; k < guided.size; ++k)
    task.tracer.direct().complete(escaped_[k], lights_[guided.items[k]], task.context);
}

void PathBatch::traceShadowRays(Task& task) {
  Indices& lit = chosen_;
  rays_.size = lit.size = 0;
  for (const uint32_t i : shaded_.all())
    if (lights_[i].hasShadowRay) {
      rays_.add(lights_[i].shadowRay);
      lit.add(i);
      if (task.context.log) task.context.log->rays.push_back({lights_[i].shadowRay, true});
    }
  task.context.counts.shadow += rays_.size;
  task.accel().transmittance(rays_.all(), std::span(transmittances_).first(rays_.size),
                             task.visible());
  for (size_t k = 0; k < lit.size; ++k)
    if (!isBlack(transmittances_[k])) {
      const DeferredLight& light = lights_[lit.items[k]];
      paths_[lit.items[k]].radiance += light.radiance * transmittances_[k];
      if (task.context.groups) [[unlikely]] {
        selectGroups(lit.items[k], task);
        task.tracer.direct().addToGroups(light, transmittances_[k], task.context);
      }
      if (task.context.records) task.context.addRecord(light.record, transmittances_[k]);
    }
}

void PathBatch::traceNextRays(Task& task) {
  Indices& traced = shaded_;  // not in use any more
  Indices& last = chosen_;
  size_t remaining = 0;
  last.size = traced.size = rays_.size = keys_.size = 0;
  for (const uint32_t i : active_.all()) {
    select(i, task);
    PathState& path = paths_[i];
    path.guided.startRest(path.radiance);
    if (task.tracer.endsAtAnyHit(path, task.context)) {
      last.add(i);
      continue;
    }
    active_.items[remaining++] = i;
    if (path.place) [[unlikely]] {
      hits_[i] = task.tracer.nextHit(path, task.context);
      continue;
    }
    traced.add(i);
    rays_.add(path.ray);
    keys_.add(task.context.sampler.sampleKey());
    if (task.context.log) task.context.log->rays.push_back({path.ray, false});
  }
  active_.size = remaining;
  task.accel().intersect(rays_.all(), keys_.all(), Accel::Coherence::None,
                         std::span(found_).first(rays_.size), task.visible());
  for (size_t k = 0; k < traced.size; ++k) hits_[traced.items[k]] = found_[k];
  traceLastRays(last, task);
}

// The paths whose rays escape go on, to find the light there.
void PathBatch::traceLastRays(const Indices& paths, Task& task) {
  rays_.size = 0;
  for (const uint32_t i : paths.all()) {
    rays_.add(paths_[i].ray);
    if (task.context.log) task.context.log->rays.push_back({paths_[i].ray, true});
  }
  task.accel().transmittance(rays_.all(), std::span(transmittances_).first(rays_.size),
                             task.visible());
  for (size_t k = 0; k < paths.size; ++k)
    if (!isBlack(transmittances_[k])) {
      hits_[paths.items[k]].reset();
      active_.add(paths.items[k]);
    }
}

}  // namespace chromeball
