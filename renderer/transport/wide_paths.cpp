// SPDX-License-Identifier: Apache-2.0
#include "transport/wide_paths.h"

#include <algorithm>
#include <numeric>

#include "transport/camera_samples.h"
#include "transport/first_surface.h"
#include "transport/path_lanes.h"

namespace chromeball {
namespace {

using L = LanesOf<Float8>;
using Vector = Lanes3<Float8>;
constexpr size_t kWidth = L::kCount;

// As toUnit().
Float8 unitsOf(const LaneArray<uint32_t>& bits, size_t i) {
  const Int8 b = Int8(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(&bits[i])));
  return L::toFloat(Int8(_mm256_srli_epi32(__m256i(b), 8))) * 0x1p-24f;
}

// The least alpha behind a bounce (spreadOf()); 0 without regularisation or behind a mirror.
Float8 widenedBy(Float8 widening, Float8 pdf) {
  const Float8 spread = smaller(L::splat(1), 1 / L::squareRoot(kPi * pdf));
  return pdf > 0 ? widening * spread : Float8{};
}

}  // namespace

struct WidePaths::Task {
  const CameraSamples& cameras;
  const PathTracer& tracer;
  PathContext& context;
  PathBatch& rest;
  std::span<Rgb> radiances;

  const World& world() const { return tracer.world(); }
  const PathSettings& settings() const { return tracer.settings(); }
  const LightSource& lighting() const { return tracer.lighting(); }
};

bool WidePaths::serves(const PathTracer& tracer, const PathContext& context) {
  const World& world = tracer.world();
  const PathSettings& s = tracer.settings();
  return world.plain.any() && !world.scene.moves && world.sources.distant.empty() &&
         tracer.mirrorAlpha() == 0 && tracer.lighting().sampleMany({}, {}) && s.maxDepth > 0 &&
         !s.limitsKinds() && s.compared == s.visible && (!s.guide || s.guide->empty()) &&
         (!s.caustics || s.caustics->empty()) && !context.groups && !context.log;
}

void WidePaths::Paths::add(const Paths& from, size_t i, const LanePacking& packing) {
  const auto copy = [&](auto& to, const auto& array) {
    packing.store(&to[size], loadLanes(&array[i]));
  };
  const auto copy3 = [&](LaneArrays3& to, const LaneArrays3& arrays) {
    to.store(size, arrays.load(i), packing);
  };
  copy3(rays.origin, from.rays.origin), copy3(rays.direction, from.rays.direction);
  copy3(throughput, from.throughput);
  copy(pdf, from.pdf), copy(length, from.length);
  copy(id, from.id), copy(scattered, from.scattered);
  copy(widening, from.widening), copy(minAlpha, from.minAlpha);
  copy(hits.instance, from.hits.instance), copy(hits.triangle, from.hits.triangle);
  copy(hits.u, from.hits.u), copy(hits.v, from.hits.v), copy(hits.distance, from.hits.distance);
  if (keepsVertices) {
    copy3(throughputBefore, from.throughputBefore);
    copy3(position, from.position), copy3(normal, from.normal);
  }
  size += packing.count();
}

template <class IsGone>
void WidePaths::Paths::removeIf(const IsGone& isGone) {
  const size_t count = std::exchange(size, 0);
  for (size_t i = 0; i < count; i += kWidth) {
    const unsigned here = bitsOf(firstLanes(count - i)), gone = isGone(i, here);
    if (gone == 0 && size == i)
      size += size_t(std::popcount(here));
    else
      add(*this, i, LanePacking(here & ~gone));
  }
}

void WidePaths::start(const Task& task) {
  depth_ = 0;
  left_.clear();
  for (Paths* const paths : {paths_, next_, &escaped_})
    paths->keepsVertices = task.context.records || !task.world().sources.all.empty();
  Paths& paths = *paths_;
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
}

void WidePaths::follow(const CameraSamples& cameras, const PathTracer& tracer, PathContext& context,
                       PathBatch& rest, std::span<Rgb> radiances) {
  const Task task{cameras, tracer, context, rest, radiances};
  start(task);
  for (;;) {
    endEscaped(task);
    if (depth_ == task.settings().maxDepth) return endAtLimit(task);
    leaveLanes(task);
    if (paths_->size == 0) return;
    fillVertices(task);
    addEmission(task);
    noteFirst(task);
    drawNumbers(task);
    task.lighting().sampleArrays(std::span(numbers_[dimension::kLight]).first(paths_->size),
                                 numbers_[dimension::kLight + 1].data(), lights_);
    scatter(task);
    traceShadowRays(task);
    if (!sceneLights_.isEmpty()) sceneLights_.trace(tracer, keys_, context, radiances);
    ++depth_;
    std::swap(paths_, next_);
    if (depth_ == task.settings().maxDepth && tracer.surfacesEndPaths())
      traceLastRays(task);
    else
      traceRays(task);
  }
}

void WidePaths::setKeys(const Task& task) {
  for (size_t k = 0; k < paths_->size; ++k)
    keys_[k] = PixelSampler::vertexKey(task.cameras.numbers(size_t(paths_->id[k])), depth_);
}

void WidePaths::traceRays(const Task& task) {
  setKeys(task);
  task.world().accel.intersect(paths_->rays, paths_->size, std::span(keys_).first(paths_->size),
                               Accel::Coherence::None, paths_->hits, task.settings().visible);
}

// As PathTracer::endsAtAnyHit().
void WidePaths::traceLastRays(const Task& task) {
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
bool WidePaths::isFollowed(const Task& task, size_t path) const {
  return task.settings().estimateDepthCut && PathTracer::isFollowed(DepthLimit::Depth, keys_[path]);
}

void WidePaths::endAtLimit(const Task& task) {
  setKeys(task);
  for (size_t k = 0; k < paths_->size; ++k) {
    const PlainSurfaces::Part& part = partOf(task, k);
    const bool mayBeHidden = part.hidesBack && paths_->pdf[k] == 0;
    if (isNotForLanes(task, k) || part.emits || mayBeHidden || isFollowed(task, k))
      handOver(task, k);
  }
}

const PlainSurfaces::Part& WidePaths::partOf(const Task& task, size_t path) const {
  return task.world().plain.part(size_t(paths_->hits.instance[path]));
}

bool WidePaths::isNotForLanes(const Task& task, size_t path) const {
  const HitArrays& hits = paths_->hits;
  return partOf(task, path).kind == PlainSurfaces::Kind::Other ||
         task.world().sharedPlaces.contains(uint32_t(hits.instance[path]),
                                            uint32_t(hits.triangle[path]));
}

// Paths whose first hit notes what is seen in smooth mirrors leave the lanes there.
bool WidePaths::notesMirrored(const Task& task, size_t path) const {
  return depth_ > 0 && paths_->pdf[path] == 0 && task.cameras.first(size_t(paths_->id[path]));
}

void WidePaths::leaveLanes(const Task& task) {
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

void WidePaths::handOver(const Task& task, size_t k) {
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
  task.rest.add(camera, state, paths_->hits.at(k));
  left_.push_back(uint32_t(id));
}

void WidePaths::endEscaped(const Task& task) {
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
    task.lighting().backgroundArrays(escaped_.rays, escaped_.size, lights_);
  else
    task.lighting().escapedArrays(escaped_.rays, escaped_.size, lights_);
  addEscaped(task);
}

// As PathTracer::addBackground() and addEscaped(). All of the probe's light is found by cameras and
// smooth mirrors.
void WidePaths::addEscaped(const Task& task) {
  LaneArrays3 found, weighted;
  for (size_t i = 0; i < escaped_.size; i += kWidth) {
    const Float8 pdf = loadLanes(&escaped_.pdf[i]);
    const Vector light = escaped_.throughput.load(i) * lights_.light.load(i);
    const Float8 weight = weightOfBsdfSample(task.settings().mis, pdf, loadLanes(&lights_.pdf[i]));
    found.store(i, light);
    weighted.store(i, chosen(pdf == 0, light, weight * light));
  }
  for (size_t k = 0; k < escaped_.size; ++k) {
    task.radiances[size_t(escaped_.id[k])] += weighted.at(k);
    if (task.context.records && escaped_.pdf[k] != 0)
      task.context.addRecord(recordOf(k, found.at(k), lights_.pdf[k]));
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

void WidePaths::fillVertices(const Task& task) {
  for (size_t k = 0; k < paths_->size; ++k) {
    const Beam& beam = task.cameras.pixel(size_t(paths_->id[k])).beam;
    crossSections_[k] = beam ? beam.crossSection(paths_->length[k] + paths_->hits.distance[k]) : 0;
  }
  vertices_.fill(task.world().scene, task.world().plain, paths_->rays, paths_->hits,
                 std::span(crossSections_).first(paths_->size));
  for (size_t k = 0; k < paths_->size; ++k) {
    int32_t& isHidden = vertices_.isHidden[k];
    isHidden &= -(paths_->pdf[k] == 0);
    if (isHidden) [[unlikely]]
      handOver(task, k);
    paths_->length[k] += paths_->hits.distance[k];
  }
}

// As PathTracer::foundEmission().
void WidePaths::addEmission(const Task& task) {
  if (task.world().sources.all.empty()) return;
  for (size_t k = 0; k < paths_->size; ++k) {
    if (!partOf(task, k).emits || vertices_.isHidden[k]) continue;
    const LightPoint from{paths_->position.at(k), paths_->normal.at(k), nullptr, depth_ - 1};
    const Instance& instance = task.world().scene.instances[size_t(paths_->hits.instance[k])];
    task.radiances[size_t(paths_->id[k])] +=
        paths_->throughput.at(k) * task.tracer.foundEmission(from, paths_->pdf[k],
                                                             paths_->rays.direction.at(k),
                                                             vertices_.surface(k), instance);
  }
}

void WidePaths::noteFirst(const Task& task) {
  for (size_t k = 0; k < paths_->size; ++k) {
    const size_t id = size_t(paths_->id[k]);
    FirstHit* const first = task.cameras.first(id);
    if (!first || vertices_.isHidden[k]) continue;
    if (depth_ > 0) {
      if (!first->direct) first->direct = task.radiances[id];
      continue;
    }
    const Instance& instance = task.world().scene.instances[size_t(paths_->hits.instance[k])];
    *first =
        firstHitAt(instance, vertices_.normal.at(k), vertices_.baseColor.at(k), paths_->length[k]);
  }
}

void WidePaths::drawNumbers(const Task& task) {
  constexpr size_t kNumbers = dimension::kPerVertex;
  static_assert(kNumbers == kWidth);
  alignas(64) std::array<std::array<float, kNumbers>, kWidth> rows;  // bits
  const PixelSampler& sampler = task.context.sampler;
  for (size_t i = 0; i < paths_->size; i += kWidth) {
    std::array<const float*, kWidth> begins;
    for (size_t k = 0; k < kWidth; ++k) {
      begins[k] = rows[k].data();
      if (i + k >= paths_->size) continue;
      sampler.vertexBits(task.cameras.numbers(size_t(paths_->id[i + k])), depth_,
                         reinterpret_cast<uint32_t*>(rows[k].data()));
    }
    const auto columns = L::columns(begins);
    for (size_t d = 0; d < kNumbers; ++d)
      storeLanes(reinterpret_cast<int32_t*>(&numbers_[d][i]), Int8(columns[d]));
  }
}

void WidePaths::scatter(const Task& task) {
  shadows_.size = next_->size = 0;
  shadows_.records.clear();
  const std::span ids(paths_->id.data(), paths_->size);
  sceneLights_.draw(task.world(), task.cameras, ids, depth_, vertices_, task.context);
  if (!sceneLights_.isEmpty()) setKeys(task);
  for (size_t i = 0; i < paths_->size; i += kWidth) scatterLanes(task, i);
  task.context.counts.bounce += next_->size;
}

// As PathTracer::scatterAs(), with DirectLight::deferDrawn().
void WidePaths::scatterLanes(const Task& task, size_t i) {
  const Int8 isHere = firstLanes(paths_->size - i) & ~loadLanes(&vertices_.isHidden[i]);
  const Vector wo = L::splat(-1) * paths_->rays.direction.load(i);
  MaterialLanes material = vertices_.material(i);
  const Float8 minAlpha = loadLanes(&paths_->minAlpha[i]);
  material.roughness = larger(material.roughness, L::squareRoot(minAlpha));  // widen()
  const PlainBsdfLanes bsdf(material, vertices_.normal.load(i), vertices_.geometricNormal.load(i),
                            wo, task.world().bsdfTables.energy.get());
  const Vector throughput = paths_->throughput.load(i);

  const Vector toLight = lights_.direction.load(i);
  const Float8 lightPdf = loadLanes(&lights_.pdf[i]);
  const BsdfLanesValue value = bsdf.evaluate(toLight);
  const Float8 weight = weightOfLightSample(task.settings().mis, lightPdf, value.pdf);
  const LanePacking lit(bitsOf(isHere & (lightPdf > 0) & ~isBlack(value.fCos)));
  const size_t s = shadows_.size;
  shadows_.rays.origin.store(s, vertices_.rayOrigin(i, toLight), lit);
  shadows_.rays.direction.store(s, toLight, lit);
  shadows_.radiance.store(s, throughput * (weight * value.fCos) * lights_.light.load(i), lit);
  lit.store(&shadows_.id[s], loadLanes(&paths_->id[i]));
  shadows_.size += lit.count();
  if (task.context.records) recordSamples(i, lit.bits(), value, bsdf.normal());
  if (!sceneLights_.isEmpty())
    sceneLights_.scatter(i, bsdf, throughput, task.settings().mis, vertices_, paths_->id);

  const BsdfLanesSample bounce = bsdf.sample(unitsOf(numbers_[dimension::kBsdf], i),
                                             unitsOf(numbers_[dimension::kBsdf + 1], i),
                                             unitsOf(numbers_[dimension::kLobe], i));
  Vector weighted = throughput * bounce.weight;
  Int8 goesOn = isHere & bounce.isValid;
  if (depth_ >= kFirstRoulette) {  // as survivesRoulette()
    const Float8 largest = larger(larger(weighted.x, weighted.y), weighted.z);
    const Float8 survival = smaller(largest, L::splat(1));
    goesOn &= ~(unitsOf(numbers_[dimension::kRoulette], i) >= survival);
    weighted = {weighted.x / survival, weighted.y / survival, weighted.z / survival};
  }
  const LanePacking on(bitsOf(goesOn));
  const size_t n = next_->size;
  next_->rays.origin.store(n, vertices_.rayOrigin(i, bounce.wi), on);
  next_->rays.direction.store(n, bounce.wi, on);
  next_->throughput.store(n, weighted, on);
  on.store(&next_->pdf[n], bounce.pdf);
  on.store(&next_->length[n], loadLanes(&paths_->length[i]));
  on.store(&next_->id[n], loadLanes(&paths_->id[i]));
  on.store(&next_->scattered[n], loadLanes(&paths_->scattered[i]) | (bounce.pdf != 0));
  const Float8 widening = loadLanes(&paths_->widening[i]);
  on.store(&next_->widening[n], widening);
  on.store(&next_->minAlpha[n], larger(minAlpha, widenedBy(widening, bounce.pdf)));
  next_->size += on.count();
  if (!next_->keepsVertices) return;
  next_->position.store(n, vertices_.position.load(i), on);
  next_->normal.store(n, bsdf.normal(), on);
  next_->throughputBefore.store(n, throughput, on);
}

// As DirectLight::record().
void WidePaths::recordSamples(size_t first, unsigned lit, const BsdfLanesValue& value,
                              const Vector& normal) {
  forBits(lit, [&](unsigned k) {
    const size_t i = first + k;
    const Rgb fCos(value.fCos.x[k], value.fCos.y[k], value.fCos.z[k]);
    const float pdf = lights_.pdf[i];
    shadows_.records.push_back({.position = vertices_.position.at(i),
                                .normal = {normal.x[k], normal.y[k], normal.z[k]},
                                .direction = lights_.direction.at(i),
                                .integrand = luminance(fCos * lights_.light.at(i)) * pdf,
                                .density = pdf + value.pdf[k],
                                .strategyPdf = pdf,
                                .bsdfPdf = value.pdf[k]});
  });
}

void WidePaths::traceShadowRays(const Task& task) {
  task.context.counts.shadow += shadows_.size;
  task.world().accel.transmittance(shadows_.rays, std::span(transmittances_).first(shadows_.size),
                                   task.settings().visible);
  for (size_t k = 0; k < shadows_.size; ++k) {
    if (chromeball::isBlack(transmittances_[k])) continue;
    task.radiances[size_t(shadows_.id[k])] += shadows_.radiance.at(k) * transmittances_[k];
    if (task.context.records) task.context.addRecord(shadows_.records[k], transmittances_[k]);
  }
}

}  // namespace chromeball
