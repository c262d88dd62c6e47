// SPDX-License-Identifier: Apache-2.0
#include "composite/differential.h"

#include <array>
#include <utility>

#include "transport/camera_samples.h"

namespace chromeball {
namespace {

// The layers of a place that the world without objects has too, for a path that continues in
// `direction`: starting at the path's surface or the next of the layers.
Place withoutObjects(const CompositeWorlds& worlds, const Place& place, const vec3& direction) {
  const bool ascends = glm::dot(place.axis, direction) > 0;
  Place kept = place;
  kept.count = 0;
  kept.at = ascends ? 0 : -1;
  for (int i = 0; i < place.count; ++i) {
    const Hit& hit = place.hits[size_t(i)];
    if (worlds.isObject(hit)) continue;
    kept.at += ascends ? i < place.at : i <= place.at;
    kept.hits[size_t(kept.count++)] = hit;
  }
  if (kept.at < 0 || kept.at >= kept.count) kept.count = 0;
  return kept;
}

// Paths of one world that are traced together, and the samples that they belong to.
struct Rest {
  PathBatch paths;
  std::array<size_t, PathBatch::kMaxPaths> samples;
  size_t count = 0;

  void add(size_t sample, const CameraSample& camera, const PathState& state,
           const std::optional<Hit>& hit) {
    paths.add(camera, state, hit);
    samples[count++] = sample;
  }
  void clear() { paths.clear(), count = 0; }
};

struct Rests {
  Rest withObjects, without;
};

// Estimates the part of sample `i` that both worlds share, and adds the paths from where they
// differ to `rests`.
DifferentialSample sharedPart(const CompositeWorlds& worlds, size_t i, const CameraSample& camera,
                              bool behindObjects, PathContext& context, Rests& rests) {
  const auto& [whole, local, shared] = worlds;
  DifferentialSample sample;
  PathState state = camera.path();
  ++context.counts.camera;
  camera.start(context.sampler);
  context.sampler.startVertex(0);
  for (std::optional<Hit> hit = camera.hit;;) {
    const bool isInPlace = bool(state.place);  // and has crossed some of its layers
    float weight = 1;
    const std::optional<Hit> met = hit ? whole.metAt(state, *hit, weight, context) : std::nullopt;
    if (met) hit = met;
    if ((met && worlds.isObject(*met)) || weight != 1) {
      // The ray hits an object, or there is a choice at its end that depends on objects: from here
      // on the paths of the two worlds differ.
      sample.objectFirst = state.depth == 0;
      PathState withObjects = state;
      if (met) withObjects.throughput *= weight;
      rests.withObjects.add(i, camera, withObjects, hit);
      if (sample.objectFirst && !behindObjects) return sample;
      state.first = nullptr;
      state.place = isInPlace ? withoutObjects(worlds, state.place, state.ray.direction) : Place();
      context.sampler.startVertex(state.depth);
      rests.without.add(i, camera, state, local.nextHit(state, context));
      return sample;
    }
    whole.estimateDepthCut(state, hit, context);
    PathState without = state;
    without.first = nullptr;
    if (state.place) [[unlikely]]
      without.place = withoutObjects(worlds, state.place, state.ray.direction);
    // A shadow ray that starts in the place crosses its layers without being traced.
    context.shadowsDiffer = without.place.count != state.place.count;
    const bool continues = shared.vertex(state, hit, context);
    const Rgb found = std::exchange(state.radiance, Rgb(0));
    // An object casts a shadow on the vertex or lights it: evaluate it again without objects.
    if (context.shadowsDiffer) {
      sample.withObjects += found;
      local.vertex(without, hit, context);
      sample.without += without.radiance;
    } else {
      sample.both += found;
    }
    if (!continues) return sample;
    context.sampler.startVertex(state.depth);
    state.guided.startRest(state.radiance);
    hit = whole.nextHit(state, context);
  }
}

}  // namespace

void differentialRadiance(const CompositeWorlds& worlds, const CameraSamples& cameras,
                          bool behindObjects, PathContext& context,
                          std::span<DifferentialSample> samples) {
  thread_local Rests rests;
  auto& [withObjects, without] = rests;
  withObjects.clear(), without.clear();
  for (size_t i = 0; i < cameras.size(); ++i)
    samples[i] = sharedPart(worlds, i, cameras[i], behindObjects, context, rests);
  withObjects.paths.follow(worlds.whole, context);
  const auto records = std::exchange(context.records, nullptr);  // those with objects suffice
  without.paths.follow(worlds.local, context);
  context.records = records;
  for (size_t k = 0; k < withObjects.count; ++k)
    samples[withObjects.samples[k]].withObjects += withObjects.paths.radiance(k);
  for (size_t k = 0; k < without.count; ++k)
    samples[without.samples[k]].without += without.paths.radiance(k);
}

void DifferentialIntegrator::sampleMany(const CameraSamples& cameras, PathContext& context,
                                        std::span<Sample> samples) const {
  std::array<DifferentialSample, PathBatch::kMaxPaths> found;
  differentialRadiance(worlds_, cameras, behindObjects_, context, found);
  for (size_t i = 0; i < cameras.size(); ++i) samples[i] = composed(found[i], cameras[i], context);
}

Sample DifferentialIntegrator::composed(const DifferentialSample& s, const CameraSample& camera,
                                        PathContext& context) const {
  const Rgb withObjects = s.both + s.withObjects, without = s.both + s.without;
  context.depthCut.addFound(withObjects);
  for (const Rgb& radiance : {withObjects, without})
    if (const auto defect = defectOf(radiance, false)) return {radiance, defect};

  const std::span<Rgb> layers = camera.layers;
  if (s.objectFirst) {
    const Rgb seen = context.clamp(withObjects);
    layers[DifferentialFilm::kCoverage] = Rgb(1);
    layers[DifferentialFilm::kObjects] = seen;
    layers[DifferentialFilm::kBehind] = without;
    return seen;
  }
  const Rgb difference = context.clamp(s.difference());
  layers[DifferentialFilm::kLocal] = without;
  layers[DifferentialFilm::kDifference] = difference;
  return {(plate_.empty() ? without : plate_.rgb(camera.pixel->x, camera.pixel->y)) + difference,
          std::nullopt};
}

}  // namespace chromeball
