// SPDX-License-Identifier: Apache-2.0
#include "transport/media.h"

#include <algorithm>

#include "trace/accel.h"
#include "transport/world.h"

namespace chromeball {
namespace {

// KHR_materials_dispersion: the index rises from red to blue by (ior - 1) / Abbe number, where
// dispersion = 20 / Abbe number.
Rgb indexByChannel(const Material& m) {
  const float half = (m.ior - 1) * 0.025f * m.extended->dispersion;
  return glm::max(Rgb(m.ior - half, m.ior, m.ior + half), Rgb(1));
}

// The index of the only nonzero channel; -1 unless exactly one channel is nonzero.
int onlyChannel(const Rgb& c) {
  if (int(c.x != 0) + int(c.y != 0) + int(c.z != 0) != 1) return -1;
  return c.x != 0 ? 0 : c.y != 0 ? 1 : 2;
}

// The relative index of a ray from `from` to `to`; null: air.
Rgb relativeIndex(const Material* from, const Material* to, const Rgb& throughput) {
  const Rgb one(1);
  const Rgb index = (to ? indexByChannel(*to) : one) / (from ? indexByChannel(*from) : one);
  const int channel = onlyChannel(throughput);
  return channel < 0 ? index : Rgb(index[channel]);
}

}  // namespace

Media Media::around(const World& world, Ray ray, uint32_t key, RayMask mask) {
  constexpr uint32_t kMostSurfaces = 256;
  Media around, entered;
  Hit hit;
  for (uint32_t i = 0; world.hasBodies && i < kMostSurfaces; ++i) {
    if (!world.accel.intersect(ray, key + i, hit, mask)) break;
    const Surface surface = surfaceAt(world.scene, world.scene.instances[hit.instance],
                                      hit.triangle, hit.barycentric, -ray.direction, 0, ray.time);
    if (surface.frontFace || entered.find(surface.material) >= 0)
      entered.follow(surface, ray.direction);
    else if (surface.material->isBody() && around.count_ < int(around.bodies_.size()))
      around.bodies_[size_t(around.count_++)] = surface.material;
    ray = rayFrom(surface, ray.direction);
  }
  std::reverse(around.bodies_.begin(), around.bodies_.begin() + around.count_);
  return around;
}

int Media::find(const Material* body) const {
  int i = count_ - 1;
  while (i >= 0 && bodies_[size_t(i)] != body) --i;
  return i;
}

RefractiveIndex Media::refractiveIndex(const Surface& s, const Rgb& throughput) const {
  const Material& m = *s.material;
  const bool isFull = count_ == int(bodies_.size());
  if (s.frontFace) {
    if (isFull) return {Rgb(1), m.ior};  // not tracked: no refraction
    const Material* outer = count_ > 0 ? bodies_[size_t(count_ - 1)] : nullptr;
    return {relativeIndex(outer, &m, throughput), m.ior};
  }
  const int location = find(&m);
  // Still inside a body that was entered later, or not tracked on entry: no refraction.
  if (location >= 0 ? location < count_ - 1 : isFull) return {Rgb(1), m.ior};
  const Material* outer = location > 0 ? bodies_[size_t(location - 1)] : nullptr;
  return {relativeIndex(&m, outer, throughput), m.ior};
}

Media& Media::follow(const Surface& s, const vec3& wi) {
  const auto& extended = s.material->extended;
  if (!extended || extended->thinWalled || glm::dot(s.geometricNormal, wi) >= 0) return *this;
  if (s.frontFace) {
    if (count_ < int(bodies_.size())) bodies_[size_t(count_++)] = s.material;
  } else if (const int location = find(s.material); location >= 0) {
    for (int i = location; i + 1 < count_; ++i) bodies_[size_t(i)] = bodies_[size_t(i + 1)];
    --count_;
  }
  return *this;
}

}  // namespace chromeball
