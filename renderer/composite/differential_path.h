// SPDX-License-Identifier: Apache-2.0
// Radiance with the synthetic objects and without them, along paths that are one until an object
// matters: differential rendering (HDRI book, 9.7.1) in one pass.
#pragma once

#include <utility>

#include "integrate/integrator.h"

namespace chromeball {

// By index of the instance: true for what is put into the picture, false for the local scene.
using ObjectMask = std::vector<bool>;

// What the local scene alone answers. A lamp that is one of the objects is not there.
struct LocalRays {
  const Accel& local;
  const ObjectMask& isObject;

  bool intersect(const Ray& ray, uint32_t key, Hit& hit) const {
    return local.intersect(ray, key, hit);
  }
  Rgb transmittance(const Ray& ray) const { return local.transmittance(ray); }
};
inline Rgb transmittanceTo(const LocalRays& rays, uint32_t instance, const Ray& ray) {
  return rays.isObject[instance] ? Rgb(0) : rays.transmittance(ray);
}

// Answers for the whole scene, and remembers whether the local scene alone would let another share
// of light pass.
class WatchedRays {
 public:
  WatchedRays(const Accel& whole, const LocalRays& local) : whole_(whole), local_(local) {}

  bool intersect(const Ray& ray, uint32_t key, Hit& hit) const {
    return whole_.intersect(ray, key, hit);
  }
  Rgb transmittance(const Ray& ray) const {
    const Rgb passed = whole_.transmittance(ray);
    return passed == Rgb(1) ? passed : compared(passed, local_.transmittance(ray));
  }
  friend Rgb transmittanceTo(const WatchedRays& rays, uint32_t instance, const Ray& ray) {
    return rays.local_.isObject[instance] ? rays.compared(rays.whole_.transmittance(ray), Rgb(0))
                                          : rays.transmittance(ray);
  }

  // Since the last call.
  bool haveDiffered() const { return std::exchange(differ_, false); }

 private:
  Rgb compared(const Rgb& whole, const Rgb& local) const {
    // Blended surfaces met in another order make a product that is rounded otherwise.
    constexpr float kRounding = 1e-6f;
    differ_ |= maxComponent(glm::abs(local - whole)) > kRounding;
    return whole;
  }

  const Accel& whole_;
  const LocalRays& local_;
  mutable bool differ_ = false;
};

struct DifferentialSample {
  Rgb both{0};                     // found with the objects and without them
  Rgb withObjects{0}, without{0};  // found only so
  bool objectFirst = false;        // the camera sees an object

  Rgb difference() const { return withObjects - without; }
};

// Whether the path passes the surface at `hit` as if it were not there: a back that is hidden.
inline bool isUnseen(const Scene& scene, const PathState& state, const Hit& hit) {
  const Instance& instance = scene.instances[hit.instance];
  return scene.materials[size_t(instance.material)].hidesBack() &&
         isHiddenFrom(state, surfaceAt(scene, instance, hit.triangle, hit.barycentric,
                                       -state.ray.direction));
}

// Takes the camera's path past hidden backs, to before the first surface that it sees.
template <class Rays>
std::optional<Hit> passUnseen(const Scene& scene, const Rays& rays, PathState& state,
                              std::optional<Hit> hit, const PixelSampler& sampler) {
  while (hit && isUnseen(scene, state, *hit)) {
    const Surface back = surfaceAt(scene, scene.instances[hit->instance], hit->triangle,
                                   hit->barycentric, -state.ray.direction);
    state.length += hit->distance;
    state.ray.origin = back.rayOrigin(state.ray.direction);
    hit = closestHit(rays, state.ray, sampler);
  }
  return hit;
}

// Both worlds in which a sample is taken.
struct DifferentialScene {
  PathScene<Accel> whole;
  PathScene<LocalRays> local;
  const ObjectMask& isObject;
  // Whether the camera asks what the local scene looks like behind objects.
  bool looksBehind;
};

// `camera.hit` is the whole scene's. Random numbers are the same in both worlds, and whatever is
// computed before an object is met or shades something is computed once, so that where objects
// change nothing `difference()` is zero to the last bit.
inline DifferentialSample differentialRadiance(const DifferentialScene& scene,
                                               const CameraSample& camera, PathMemory& memory,
                                               FirstHit* first) {
  PixelSampler& sampler = memory.sampler;
  std::vector<DirectionSample>& samples = memory.samples;
  RayCounts& counts = memory.rays;
  const auto& [whole, local, isObject, looksBehind] = scene;
  const WatchedRays rays(whole.rays, local.rays);
  const PathScene<WatchedRays> shared{whole.scene,       rays,
                                      whole.lighting,    whole.emitters,
                                      whole.mis,         whole.maxDepth,
                                      whole.hideProbe,   whole.punctual,
                                      whole.mirrorAlpha, whole.maxTransmissionDepth};

  DifferentialSample sample;
  PathState state = camera.path();
  ++counts.camera;
  sampler.startVertex(0);
  for (std::optional<Hit> hit = camera.hit;;) {
    if (hit && isObject[hit->instance] &&
        !isUnseen(whole.scene, state, *hit)) {  // from here on there are two paths
      sample.objectFirst = state.depth == 0;
      sample.withObjects += followPath(whole, state, hit, sampler, samples, counts, first);
      if (sample.objectFirst && !looksBehind) return sample;
      sampler.startVertex(state.depth);
      hit = closestHit(local.rays, state.ray, sampler);
      sample.without += followPath(local, state, hit, sampler, samples, counts, nullptr);
      return sample;
    }
    watchDepth(whole, state, hit, sampler, samples, counts);
    PathState before = state;
    Rgb found(0);
    const bool goesOn = pathVertex(shared, state, hit, sampler, samples, counts, first, found);
    if (rays.haveDiffered()) {  // an object's shadow, or its light: once more without it
      sample.withObjects += found;
      pathVertex(local, before, hit, sampler, samples, counts, nullptr, sample.without);
    } else {
      sample.both += found;
    }
    if (!goesOn) return sample;
    sampler.startVertex(state.depth);
    hit = closestHit(rays, state.ray, sampler);
  }
}

}  // namespace chromeball
