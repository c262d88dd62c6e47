// SPDX-License-Identifier: Apache-2.0
// Closest hits of rays and transmittance of shadow rays.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "scene/scene.h"
#include "scene/surface.h"
#include "trace/ray.h"

struct RTCSceneTy;

namespace chromeball {

class BuiltGeometry;
class NearInstances;
struct FilterUse;
struct HitArrays;
struct RayArrays;

// Embree's BVH over a scene's instances. A mesh with several instances is built once. Filter
// functions handle alpha (masked and blended surfaces), so that the path loop need not, and let
// shadow rays pass smooth thin walls; scenes without such surfaces have no filter functions.
class Accel {
 public:
  // `masks`: by instance; empty: kAllInstances for each. The scene must outlive this. `earlier`:
  // the geometry of a structure over the same Scene before it changed; its unchanged parts are
  // reused, and that structure must not be used any more. Throws RunError.
  explicit Accel(const Scene& scene, const std::vector<RayMask>& masks = {},
                 std::shared_ptr<BuiltGeometry> earlier = nullptr);
  ~Accel();
  Accel(const Accel&) = delete;
  Accel& operator=(const Accel&) = delete;

  const Scene& scene() const { return described_; }
  const std::shared_ptr<BuiltGeometry>& built() const { return built_; }
  RayMask mask(uint32_t instance) const {
    return masks_.empty() ? kAllInstances : masks_[instance];
  }

  // Whether rays may pass some surface: one that is masked or blended, or that lets shadow rays
  // through.
  bool hasFilter() const { return hasFilter_; }
  // Whether shadow rays depend on the bodies that contain their origin: they pass some
  // (Material::straightShadows), or some are masked or blended.
  bool needsMedia() const { return needsMedia_; }

  // The closest hit; none for a ray with a NaN or with coordinates beyond 1e18. `key` seeds the
  // random choice at blended surfaces, which let the ray pass with probability 1 - alpha.
  bool intersect(const Ray& ray, uint32_t key, Hit& hit, RayMask mask = kAllInstances) const;

  // The closest hits of several rays, faster than one at a time. Coherent: rays that are close
  // together, such as those through one pixel. `keys`: one per ray, as above.
  enum class Coherence { None, High };
  void intersect(std::span<const Ray> rays, std::span<const uint32_t> keys, Coherence coherence,
                 std::span<std::optional<Hit>> hits, RayMask mask = kAllInstances) const;

  // The same for the first `count` rays of the arrays (trace/hit_arrays.h), at time 0.
  void intersect(const RayArrays& rays, size_t count, std::span<const uint32_t> keys,
                 Coherence coherence, HitArrays& hits, RayMask mask) const;

  // Calls visit(hit) for all other surfaces at the place of `surface`, which the ray has hit: the
  // surfaces that a ray continuing from Surface::rayOrigin() on its other side would miss. `hit`
  // and `key`: intersect()'s.
  template <class Visit>
  void forEachCoincident(const Ray& ray, const Hit& hit, const Surface& surface, uint32_t key,
                         RayMask mask, Visit&& visit) const {
    visitCoincident(
        ray, hit, surface, key, mask,
        [](const Hit& other, void* function) {
          (*static_cast<std::remove_reference_t<Visit>*>(function))(other);
        },
        &visit);
  }

  // Calls visit(instance, triangle) for all triangles that come within `radius` metres of the point
  // at the time, and for some of their neighbours. visit() returns whether to go on.
  template <class Visit>
  void forEachNear(const vec3& point, float radius, float time, Visit&& visit) const {
    visitNear(
        point, radius, time,
        [](uint32_t instance, uint32_t triangle, void* function) -> bool {
          return (*static_cast<std::remove_reference_t<Visit>*>(function))(instance, triangle);
        },
        &visit);
  }

  // The transmittance along the ray up to tMax: 0, 1, or the product over blended surfaces
  // (1 - alpha), surfaces that pass shadow rays (scene/extended_surface.h) and absorption. The ray
  // points towards the light; it passes the front of a surface with
  // Material::backLetsLightThrough(). `attenuation`: in the medium at the ray's origin, 1/m. An
  // infinite ray must leave all bodies that it is in or enters; else a mesh is open, and nothing is
  // absorbed. `inside`: the bodies that contain the origin.
  Rgb transmittance(const Ray& ray, RayMask mask = kAllInstances, const Rgb& attenuation = Rgb(0),
                    std::span<const Material* const> inside = {}) const;

  // The same for several rays that start in air.
  void transmittance(std::span<const Ray> rays, std::span<Rgb> transmittances,
                     RayMask mask = kAllInstances) const;
  // The same for the first rays of the arrays, at time 0.
  void transmittance(const RayArrays& rays, std::span<Rgb> transmittances, RayMask mask) const;

 private:
  using VisitHit = void (*)(const Hit&, void*);
  void visitCoincident(const Ray& ray, const Hit& hit, const Surface& surface, uint32_t key,
                       RayMask mask, VisitHit visit, void* visitor) const;
  using VisitTriangle = bool (*)(uint32_t instance, uint32_t triangle, void*);
  void visitNear(const vec3& point, float radius, float time, VisitTriangle visit,
                 void* visitor) const;
  void build();
  // Up to kRays rays.
  template <size_t kRays>
  void intersectPacket(std::span<const Ray> rays, std::span<const uint32_t> keys,
                       Coherence coherence, std::span<std::optional<Hit>> hits, RayMask mask) const;
  template <size_t kRays>
  void occludedPacket(std::span<const Ray> rays, std::span<Rgb> transmittances, RayMask mask) const;
  template <size_t kRays>
  void intersectArrays(const RayArrays& rays, size_t begin, size_t count,
                       std::span<const uint32_t> keys, Coherence coherence, HitArrays& hits,
                       RayMask mask) const;
  template <size_t kRays>
  void occludedArrays(const RayArrays& rays, size_t begin, std::span<Rgb> transmittances,
                      RayMask mask) const;
  bool closest(const Ray& ray, uint32_t key, RayMask mask, Hit& hit) const;
  void resolveEdge(Ray ray, uint32_t key, RayMask mask, Hit& hit) const;

  const Scene& described_;
  std::vector<RayMask> masks_;  // by instance; empty: all
  std::shared_ptr<BuiltGeometry> built_;
  RTCSceneTy* scene_ = nullptr;
  std::unique_ptr<NearInstances> nearInstances_;  // null: nothing is traced as an instance
  size_t widest_ = 8;                             // packet that the processor has vectors for
  bool hasFilter_ = false, hasAlpha_ = false, needsMedia_ = false;
};

// Rays that leave a surface.

// A ray from the surface, at the time at which the surface is seen.
inline Ray rayFrom(const Surface& surface, const vec3& direction, float tMax = INFINITY) {
  return {surface.rayOrigin(direction), direction, tMax, surface.time};
}

// The Embree that runs, which has code for several instruction sets and chooses one.

struct EmbreeVersion {
  std::string version;  // "3.13.5"
  int lanes;            // rays that it traces at once: 4 with SSE, 8 with AVX, 16 with AVX-512
};
EmbreeVersion embreeVersion();

}  // namespace chromeball
