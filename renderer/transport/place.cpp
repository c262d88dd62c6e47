// SPDX-License-Identifier: Apache-2.0
// PathTracer: the surfaces that a path meets where several coincide.
#include "transport/place.h"

#include <algorithm>
#include <span>
#include <tuple>

#include "scene/placed_triangles.h"
#include "transport/pass_through.h"
#include "transport/path.h"

namespace chromeball {
namespace {

auto orderOf(const Hit& hit) { return std::tuple(hit.instance, hit.triangle); }

// Collects the surfaces that a path does not ignore, in any order.
class PlaceCollector {
 public:
  PlaceCollector(const Scene& scene, const PathState& state) : scene_(scene), state_(state) {}

  void add(const Hit& hit) {
    const Instance& instance = scene_.instances[hit.instance];
    const Material& material = scene_.materials[size_t(instance.material)];
    const bool front =
        !isFromBehind(scene_, instance, hit.triangle, state_.ray.direction, state_.ray.time);
    if (ignores(state_, material, front)) return;
    ++count_;
    if (material.transmits())
      return addLayer({hit, !material.isBody() ? kSheet : front ? kEntered : kLeft});
    // Among several opaque surfaces the path meets a front face, and among front faces one that
    // emits.
    const int rank = !front ? 2 : material.emits() ? 0 : 1;
    keepFirst(passesFromBehind(state_, material, front) ? oneWay_ : opaque_, {hit, rank});
  }

  int count() const { return count_; }

  // The fronts that pass light from behind, as one; none where an opaque surface blocks that light.
  std::optional<Hit> oneWay() const {
    return oneWay_ && !opaque_ ? std::optional(oneWay_->hit) : std::nullopt;
  }

  // The other surfaces, or oneWay() alone if the path is `atOneWay`. `axis`: unit, on the side to
  // which the path goes.
  Place place(const vec3& axis, float rayOffset, bool atOneWay) {
    Place place;
    place.axis = axis;
    place.rayOffset = rayOffset;
    if (const std::optional<Layer>& alone = atOneWay ? oneWay_ : opaque_) {
      place.count = 1;
      place.hits[0] = alone->hit;
      return place;
    }
    const auto layers = std::span(layers_).first(size_t(layerCount_));
    const bool ascends = glm::dot(axis, vec3(0.8147f, 0.9058f, 0.1270f)) > 0;
    std::ranges::sort(layers, [&](const Layer& a, const Layer& b) {
      if (a.rank != b.rank) return a.rank < b.rank;
      const int entered = enteredAt(a.hit), other = enteredAt(b.hit);
      if (a.rank == kLeft && entered != other) return entered > other;
      const bool isAscending = a.rank == kEntered || (a.rank == kSheet && ascends);
      return isAscending ? orderOf(a.hit) < orderOf(b.hit) : orderOf(b.hit) < orderOf(a.hit);
    });
    for (const Layer& layer : layers) place.hits[size_t(place.count++)] = layer.hit;
    return place;
  }

 private:
  struct Layer {
    Hit hit;
    int rank;  // crossed before surfaces of higher rank
  };
  static constexpr int kEntered = 0, kSheet = 1, kLeft = 2;  // ranks of surfaces that transmit

  int enteredAt(const Hit& hit) const {
    return state_.media.find(&scene_.materials[size_t(scene_.instances[hit.instance].material)]);
  }

  static void keepFirst(std::optional<Layer>& first, const Layer& layer) {
    if (!first ||
        std::tuple(layer.rank, orderOf(layer.hit)) < std::tuple(first->rank, orderOf(first->hit)))
      first = layer;
  }

  // Keeps the first kMost of the scene.
  void addLayer(const Layer& layer) {
    int i = layerCount_;
    while (i > 0 && orderOf(layer.hit) < orderOf(layers_[size_t(i - 1)].hit)) --i;
    if (i == Place::kMost) return;
    layerCount_ = std::min(layerCount_ + 1, Place::kMost);
    std::copy_backward(layers_.begin() + i, layers_.begin() + layerCount_ - 1,
                       layers_.begin() + layerCount_);
    layers_[size_t(i)] = layer;
  }

  const Scene& scene_;
  const PathState& state_;
  int count_ = 0, layerCount_ = 0;
  std::optional<Layer> opaque_, oneWay_;
  std::array<Layer, Place::kMost> layers_;  // ascending by orderOf()
};

}  // namespace

// Not inlined, because most surfaces let no path pass.
[[gnu::noinline]] std::optional<Hit> PathTracer::metAt(PathState& state, const Hit& hit,
                                                       const Surface& surface, float& weight,
                                                       PathContext& context) const {
  PlaceCollector found(world_.scene, state);
  found.add(hit);
  const bool isMet = found.count() == 1;
  if (world_.loneTriangles.contains(hit.instance, hit.triangle))
    return isMet ? std::optional(hit) : std::nullopt;
  float rayOffset = surface.rayOffset;
  world_.accel.forEachCoincident(state.ray, hit, surface, context.sampler.sampleKey(),
                                 settings_.visible, [&](const Hit& other) {
                                   found.add(other);
                                   rayOffset =
                                       std::max(rayOffset, surfaceOf(state, other).rayOffset);
                                 });
  if (found.count() == 0) return std::nullopt;
  if (isMet && found.count() == 1) return hit;
  const auto oneWay = found.oneWay();
  if (oneWay) weight = 2;
  const bool atOneWay = oneWay && !continuesBehind(*oneWay, context.sampler);
  const Place place = found.place(-surface.geometricNormal, rayOffset, atOneWay);
  if (!place) return std::nullopt;
  state.place = place;
  return state.place.current();
}

std::optional<Hit> PathTracer::metAt(PathState& state, const Hit& hit, float& weight,
                                     PathContext& context) const {
  const Instance& instance = world_.scene.instances[hit.instance];
  const Material& material = world_.scene.materials[size_t(instance.material)];
  const bool isPassed = state.isDelta ? material.hidesBack() : material.backLetsLightThrough();
  const bool isShared = sharesPlace(hit);
  if (state.place || !(material.transmits() || isPassed || isShared)) return hit;
  const Surface surface = surfaceOf(state, hit);
  return isShared || mayPass(state, surface) ? metAt(state, hit, surface, weight, context) : hit;
}

std::optional<Hit> PathTracer::metAt(PathState& state, const Hit& hit, PathContext& context) const {
  float weight = 1;
  const auto met = metAt(state, hit, weight, context);
  if (met) state.throughput *= weight;  // else vertex() chooses again, and in the same way
  return met;
}

float offsetAtPlace(const Scene& scene, const Surface& surface, const Hit& hit) {
  return planeOffset(scene, scene.instances[hit.instance], hit.triangle, surface.geometricNormal,
                     surface.time);
}

Rgb transmittanceAtPlace(const World& world, const Media& media, const Ray& ray, const Hit& emitter,
                         uint32_t key, RayMask mask) {
  const Scene& scene = world.scene;
  PathState state{.ray = ray, .isDelta = false, .media = media};
  PlaceCollector found(scene, state);
  found.add(emitter);
  const auto surfaceOf = [&](const Hit& hit) {
    return surfaceAt(scene, scene.instances[hit.instance], hit.triangle, hit.barycentric,
                     -ray.direction, 0, ray.time);
  };
  Surface surface = surfaceOf(emitter);
  surface.rayOffset = offsetAtPlace(scene, surface, emitter);
  world.accel.forEachCoincident(ray, emitter, surface, key, mask,
                                [&](const Hit& other) { found.add(other); });
  const auto isEmitter = [&](const Hit& hit) { return orderOf(hit) == orderOf(emitter); };
  if (const auto oneWay = found.oneWay(); oneWay && isEmitter(*oneWay)) return Rgb(1);
  Rgb passed(1);
  for (Place place = found.place(-surface.geometricNormal, 0, false); place;
       place.leave(ray.direction)) {
    const Hit& hit = place.current();
    if (isEmitter(hit)) return passed;
    passed *=
        straightTransmittance(scene, scene.instances[hit.instance], surfaceOf(hit), ray.direction);
  }
  return Rgb(0);
}

std::optional<Hit> PathTracer::skipHiddenBacks(PathState& state, std::optional<Hit> hit,
                                               PathContext& context) const {
  while (hit) {
    if (const auto met = metAt(state, *hit, context)) return met;
    const Surface back = surfaceOf(state, *hit);
    state.length += hit->distance;
    state.leave(back, state.ray.direction);
    hit = closestHit(state.ray, context);
  }
  return hit;
}

}  // namespace chromeball
