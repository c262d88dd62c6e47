// SPDX-License-Identifier: Apache-2.0
// Which surface a ray meets first, and whether one stands in its way.
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

// Embree's hierarchy over a scene's instances. A mesh that stands in several places is built once.
// Surfaces with alpha (masked or blended) are resolved here, so that the path loop never sees them,
// and smooth thin walls let shadow rays pass; scenes without them carry no filter.
class Accel {
 public:
  // Of the instances `shown` (by index) says so for; all where it is empty. The scene must outlive
  // this. Throws RunError.
  explicit Accel(const Scene& scene, const std::vector<bool>& shown = {});
  ~Accel();
  Accel(const Accel&) = delete;
  Accel& operator=(const Accel&) = delete;

  const Scene& scene() const { return described_; }

  // The closest hit; none for a ray with NaN or coordinates beyond 1e18. `key` decides where a
  // blended surface lets the ray pass: it does so with probability 1 - alpha.
  bool intersect(const Ray& ray, uint32_t key, Hit& hit) const;

  // The closest hits of rays that run side by side, as those through one pixel do; sooner than one
  // by one. `keys` as above, one for each ray.
  static constexpr int kPacket = 8;
  using Packet = std::array<std::optional<Hit>, kPacket>;
  Packet intersect(std::span<const Ray> rays, std::span<const uint32_t> keys) const;

  // The share of light that passes along the ray up to tMax: 0, 1, or the product over the blended
  // surfaces (1 - alpha) and the smooth thin walls (scene/thin_wall.h) between. Where light
  // passes the back of a surface (material.h), a ray towards the light passes its front.
  Rgb transmittance(const Ray& ray) const;

 private:
  void build(const Scene& scene, const std::vector<bool>& shown);
  bool closest(const Ray& ray, uint32_t key, Hit& hit) const;
  void settleEdge(Ray ray, uint32_t key, Hit& hit) const;
  void release();
  RTCGeometryTy* meshGeometry(const Scene& scene, int mesh) const;
  RTCSceneTy* meshScene(const Scene& scene, int mesh);

  const Scene& described_;
  RTCDeviceTy* device_ = nullptr;
  RTCSceneTy* scene_ = nullptr;
  std::vector<RTCSceneTy*> meshScenes_;  // by mesh; null where a mesh stands in one place only
  std::vector<bool> needsFilter_;        // by mesh: whether an instance lets some light pass
  bool hasFilter_ = false, hasAlpha_ = false;
};

}  // namespace chromeball
