// SPDX-License-Identifier: Apache-2.0
// Tracing rays that are given in arrays.
#include <algorithm>
#include <cassert>
#include <cstring>

#include "trace/accel.h"
#include "trace/embree.h"
#include "trace/filter.h"
#include "trace/hit_arrays.h"

namespace chromeball {
namespace {

Ray rayAt(const RayArrays& rays, size_t i) { return {rays.origin.at(i), rays.direction.at(i)}; }

// As isTraceable() of a ray.
template <size_t kRays, class Rays>
void fillPacket(const RayArrays& rays, size_t begin, size_t count, RayMask mask, int* valid,
                Rays& r) {
  constexpr float kFarthest = 1e18f;
  const auto copy = [&](float* to, const LaneArray<float>& from) {
    std::memcpy(to, &from[begin], kRays * sizeof(float));
  };
  copy(r.org_x, rays.origin.x), copy(r.org_y, rays.origin.y), copy(r.org_z, rays.origin.z);
  copy(r.dir_x, rays.direction.x), copy(r.dir_y, rays.direction.y);
  copy(r.dir_z, rays.direction.z);
  for (size_t i = 0; i < kRays; ++i) {
    const float sum = std::fabs(r.org_x[i]) + std::fabs(r.org_y[i]) + std::fabs(r.org_z[i]) +
                      std::fabs(r.dir_x[i]) + std::fabs(r.dir_y[i]) + std::fabs(r.dir_z[i]);
    valid[i] = (sum < kFarthest) & (i < count) ? -1 : 0;
    r.tnear[i] = r.time[i] = 0;
    r.tfar[i] = INFINITY;
    r.mask[i] = mask;
    r.id[i] = r.flags[i] = 0;
  }
}

}  // namespace

template <size_t kRays>
void Accel::intersectArrays(const RayArrays& rays, size_t begin, size_t count,
                            std::span<const uint32_t> keys, Coherence coherence, HitArrays& hits,
                            RayMask mask) const {
  using Packet = PacketOf<kRays>;
  alignas(64) int valid[kRays];
  alignas(64) typename Packet::RayHits r;
  fillPacket<kRays>(rays, begin, count, mask, valid, r.ray);
  for (size_t i = 0; i < kRays; ++i) r.hit.geomID[i] = r.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  Query query;
  initQueryContext(query.embree);
  chromeball::intersectPacket<Packet>(scene_, valid, r, coherence == Coherence::High, query.embree);
  const auto copy = [&](auto& to, const auto* from) {
    std::memcpy(&to[begin], from, kRays * sizeof(float));
  };
  copy(hits.triangle, r.hit.primID), copy(hits.u, r.hit.u), copy(hits.v, r.hit.v);
  copy(hits.distance, r.ray.tfar);
  const uint32_t instances = uint32_t(described_.instances.size());
  for (size_t i = 0; i < kRays; ++i) {
    const uint32_t top = r.hit.instID[0][i], geometry = r.hit.geomID[i];
    hits.instance[begin + i] = int32_t(geometry == RTC_INVALID_GEOMETRY_ID ? geometry
                                       : top < instances                   ? top
                                                                           : geometry);
  }
  for (size_t k = begin; k < begin + count; ++k) {
    if (hits.instance[k] == HitArrays::kNone) continue;
    Hit hit = *hits.at(k);
    if (!isNearEdge(hit)) [[likely]]
      continue;
    resolveEdge(rayAt(rays, k), keys[k], mask, hit);
    hits.set(k, hit);
  }
}

void Accel::intersect(const RayArrays& rays, size_t count, std::span<const uint32_t> keys,
                      Coherence coherence, HitArrays& hits, RayMask mask) const {
  assert(count <= kMostInArrays && keys.size() == count);
  if (!hasAlpha_) {
    for (size_t begin = 0; begin < count;) {
      const bool isWide = widest_ == 16 && count - begin > 8;
      const size_t some = std::min(count - begin, isWide ? size_t(16) : size_t(8));
      const auto trace = isWide ? &Accel::intersectArrays<16> : &Accel::intersectArrays<8>;
      (this->*trace)(rays, begin, some, keys, coherence, hits, mask);
      begin += some;
    }
    return;
  }
  for (size_t i = 0; i < count; ++i) {  // the filters process one ray at a time
    Hit hit{uint32_t(HitArrays::kNone), 0, {}, 0};
    intersect(rayAt(rays, i), keys[i], hit, mask);
    hits.set(i, hit);
  }
}

template <size_t kRays>
void Accel::occludedArrays(const RayArrays& rays, size_t begin, std::span<Rgb> transmittances,
                           RayMask mask) const {
  using Packet = PacketOf<kRays>;
  alignas(64) int valid[kRays];
  alignas(64) typename Packet::Rays r;
  fillPacket<kRays>(rays, begin, transmittances.size(), mask, valid, r);
  Query query;
  initQueryContext(query.embree);
  occludePacket<Packet>(scene_, valid, r, query.embree);
  for (size_t i = 0; i < transmittances.size(); ++i)
    transmittances[i] = Rgb(valid[i] && r.tfar[i] < 0 ? 0.0f : 1.0f);
}

void Accel::transmittance(const RayArrays& rays, std::span<Rgb> transmittances,
                          RayMask mask) const {
  const size_t count = transmittances.size();
  assert(count <= kMostInArrays);
  if (!hasFilter_) {
    for (size_t begin = 0; begin < count;) {
      const bool isWide = widest_ == 16 && count - begin > 8;
      const size_t some = std::min(count - begin, isWide ? size_t(16) : size_t(8));
      const auto trace = isWide ? &Accel::occludedArrays<16> : &Accel::occludedArrays<8>;
      (this->*trace)(rays, begin, transmittances.subspan(begin, some), mask);
      begin += some;
    }
    return;
  }
  for (size_t i = 0; i < count; ++i) transmittances[i] = transmittance(rayAt(rays, i), mask);
}

}  // namespace chromeball
