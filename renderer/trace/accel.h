// SPDX-License-Identifier: Apache-2.0
// The closest surface along a ray, and the transmittance of a shadow ray.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene.h"
#include "trace/ray.h"

struct RTCDeviceTy;
struct RTCGeometryTy;
struct RTCSceneTy;

namespace chromeball {

// Embree's hierarchy over a scene's instances. A mesh with several instances is built once.
// Surfaces with alpha (masked or blended) are resolved here, so that the path loop never sees them,
// and smooth thin walls let shadow rays pass; scenes without them have no filter functions.
class Accel {
 public:
  // `masks`: by instance; every instance is of all classes where it is empty. The scene must
  // outlive this. Throws RunError.
  explicit Accel(const Scene& scene, const std::vector<RayMask>& masks = {});
  ~Accel();
  Accel(const Accel&) = delete;
  Accel& operator=(const Accel&) = delete;

  const Scene& scene() const { return described_; }
  RayMask mask(uint32_t instance) const {
    return masks_.empty() ? kAllInstances : masks_[instance];
  }

  // The closest hit; none for a ray with NaN or coordinates beyond 1e18. `key` is the random number
  // that decides whether a blended surface lets the ray pass, with probability 1 - alpha.
  bool intersect(const Ray& ray, uint32_t key, Hit& hit, RayMask mask = kAllInstances) const;

  // The closest hits of coherent rays, such as those through one pixel; faster than one by one.
  // `keys` as above, one for each ray.
  static constexpr int kPacket = 8;
  using Packet = std::array<std::optional<Hit>, kPacket>;
  Packet intersect(std::span<const Ray> rays, std::span<const uint32_t> keys,
                   RayMask mask = kAllInstances) const;

  // The fraction of light that passes along the ray up to tMax: 0, 1, or the product over the
  // blended surfaces (1 - alpha) and smooth thin walls (scene/thin_wall.h) on the way. A ray
  // towards a light passes the front of a surface whose back lets light through (material.h).
  Rgb transmittance(const Ray& ray, RayMask mask = kAllInstances) const;

 private:
  void build(const Scene& scene);
  bool closest(const Ray& ray, uint32_t key, RayMask mask, Hit& hit) const;
  void settleEdge(Ray ray, uint32_t key, RayMask mask, Hit& hit) const;
  void release();
  RTCGeometryTy* meshGeometry(const Scene& scene, int mesh) const;
  RTCSceneTy* meshScene(const Scene& scene, int mesh);

  const Scene& described_;
  RTCDeviceTy* device_ = nullptr;
  RTCSceneTy* scene_ = nullptr;
  std::vector<RayMask> masks_;           // by instance; empty: all
  std::vector<RTCSceneTy*> meshScenes_;  // by mesh; null for a mesh of one instance
  std::vector<bool> needsFilter_;        // by mesh: whether an instance lets some light pass
  bool hasFilter_ = false, hasAlpha_ = false;
};

}  // namespace chromeball
