// SPDX-License-Identifier: Apache-2.0
// Tracing rays.
#include "trace/accel.h"

#include <algorithm>
#include <cassert>

#include "base/error.h"
#include "trace/embree.h"
#include "trace/filter.h"
#include "trace/ray.h"

#include <fmt/format.h>

namespace chromeball {
namespace {

RTCRay embreeRay(const Ray& ray, RayMask mask) {
  const vec3 &o = ray.origin, &d = ray.direction;
  return {o.x, o.y, o.z, 0, d.x, d.y, d.z, ray.time, ray.tMax, mask, 0, 0};
}

// Embree supports coordinates up to 1.8e18. The Debian build of Embree aborts the program for a ray
// beyond that, or with a NaN.
bool isTraceable(const Ray& ray) {
  constexpr float kFarthest = 1e18f;
  const vec3 sum = absolute(ray.origin) + absolute(ray.direction);
  return sum.x + sum.y + sum.z < kFarthest && ray.tMax >= 0;
}

template <class Rays>
void fillPacket(std::span<const Ray> rays, RayMask mask, int* valid, Rays& r) {
  for (size_t i = 0; i < rays.size(); ++i) {
    const Ray& ray = rays[i];
    valid[i] = isTraceable(ray) ? -1 : 0;
    r.org_x[i] = ray.origin.x, r.org_y[i] = ray.origin.y, r.org_z[i] = ray.origin.z;
    r.dir_x[i] = ray.direction.x, r.dir_y[i] = ray.direction.y, r.dir_z[i] = ray.direction.z;
    r.tnear[i] = 0;
    r.time[i] = ray.time;
    r.tfar[i] = ray.tMax;
    r.mask[i] = mask;
    r.id[i] = r.flags[i] = 0;
  }
}

}  // namespace

bool Accel::closest(const Ray& ray, uint32_t key, RayMask mask, Hit& hit) const {
  if (!isTraceable(ray)) return false;
  Query query;
  initQueryContext(query.embree);
  query.key = key;
  query.direction = ray.direction;
  RTCRayHit r;
  r.ray = embreeRay(ray, mask);
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect(scene_, r, query.embree);
  if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  hit = {instanceOf(described_, r.hit.instID[0], r.hit.geomID),
         r.hit.primID,
         {r.hit.u, r.hit.v},
         r.ray.tfar};
  return true;
}

// Replaces `hit` by the triangle in front of it if the ray grazes an edge (trace/ray.h); repeated
// up to three times, for corners. Triangles that share an edge are at similar distances; other hits
// of the turned ray are ignored.
void Accel::resolveEdge(Ray ray, uint32_t key, RayMask mask, Hit& hit) const {
  for (int i = 0; i < 3 && isNearEdge(hit); ++i) {
    const auto turned = turnedOffEdges(described_, ray, hit);
    Hit front;
    if (!turned || !closest(*turned, key, mask, front) ||
        (front.triangle == hit.triangle && front.instance == hit.instance) ||
        std::fabs(front.distance - hit.distance) > 0.5f * hit.distance)
      return;
    ray = *turned;
    hit = front;
  }
}

bool Accel::intersect(const Ray& ray, uint32_t key, Hit& hit, RayMask mask) const {
  if (!closest(ray, key, mask, hit)) return false;
  resolveEdge(ray, key, mask, hit);
  return true;
}

template <size_t kRays>
void Accel::intersectPacket(std::span<const Ray> rays, std::span<const uint32_t> keys,
                            Coherence coherence, std::span<std::optional<Hit>> hits,
                            RayMask mask) const {
  using Packet = PacketOf<kRays>;
  alignas(64) int valid[kRays] = {};
  alignas(64) typename Packet::RayHits r;
  fillPacket(rays, mask, valid, r.ray);
  for (size_t i = 0; i < rays.size(); ++i)
    r.hit.geomID[i] = r.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  Query query;
  initQueryContext(query.embree);
  chromeball::intersectPacket<Packet>(scene_, valid, r, coherence == Coherence::High, query.embree);
  for (size_t i = 0; i < rays.size(); ++i) {
    hits[i].reset();
    if (!valid[i] || r.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    hits[i] = {instanceOf(described_, r.hit.instID[0][i], r.hit.geomID[i]),
               r.hit.primID[i],
               {r.hit.u[i], r.hit.v[i]},
               r.ray.tfar[i]};
    resolveEdge(rays[i], keys[i], mask, *hits[i]);
  }
}

void Accel::intersect(std::span<const Ray> rays, std::span<const uint32_t> keys,
                      Coherence coherence, std::span<std::optional<Hit>> hits, RayMask mask) const {
  assert(keys.size() == rays.size() && hits.size() == rays.size());
  for (size_t begin = 0; begin < rays.size(); begin += widest_) {
    const size_t count = std::min(rays.size() - begin, widest_);
    if (!hasAlpha_ && count > 1) {  // the filters process one ray at a time
      const auto trace = count > 8 ? &Accel::intersectPacket<16> : &Accel::intersectPacket<8>;
      (this->*trace)(rays.subspan(begin, count), keys.subspan(begin, count), coherence,
                     hits.subspan(begin, count), mask);
      continue;
    }
    for (size_t i = begin; i < begin + count; ++i) {
      Hit hit;
      hits[i] = intersect(rays[i], keys[i], hit, mask) ? std::optional(hit) : std::nullopt;
    }
  }
}

template <size_t kRays>
void Accel::occludedPacket(std::span<const Ray> rays, std::span<Rgb> transmittances,
                           RayMask mask) const {
  using Packet = PacketOf<kRays>;
  alignas(64) int valid[kRays] = {};
  alignas(64) typename Packet::Rays r;
  fillPacket(rays, mask, valid, r);
  Query query;
  initQueryContext(query.embree);
  occludePacket<Packet>(scene_, valid, r, query.embree);
  for (size_t i = 0; i < rays.size(); ++i)
    transmittances[i] = Rgb(valid[i] && r.tfar[i] < 0 ? 0.0f : 1.0f);
}

void Accel::transmittance(std::span<const Ray> rays, std::span<Rgb> transmittances,
                          RayMask mask) const {
  assert(transmittances.size() == rays.size());
  for (size_t begin = 0; begin < rays.size(); begin += widest_) {
    const size_t count = std::min(rays.size() - begin, widest_);
    if (!hasFilter_ && count > 1) {  // the filters process one ray at a time
      const auto trace = count > 8 ? &Accel::occludedPacket<16> : &Accel::occludedPacket<8>;
      (this->*trace)(rays.subspan(begin, count), transmittances.subspan(begin, count), mask);
      continue;
    }
    for (size_t i = begin; i < begin + count; ++i) transmittances[i] = transmittance(rays[i], mask);
  }
}

Rgb Accel::transmittance(const Ray& ray, RayMask mask, const Rgb& attenuation,
                         std::span<const Material* const> inside) const {
  if (!isTraceable(ray)) return Rgb(1);
  Query query;
  initQueryContext(query.embree);
  query.direction = ray.direction;
  query.length = ray.tMax;
  query.attenuation = query.largestAttenuation = attenuation;
  query.inside = inside;
  if (std::isfinite(ray.tMax)) query.opticalDepth = ray.tMax * attenuation;
  RTCRay r = embreeRay(ray, mask);
  rtcOccluded(scene_, r, query.embree);
  if (r.tfar < 0) return Rgb(0);
  if (isBlack(query.opticalDepth)) return query.transmittance;
  constexpr float kRounding = 1e-4f;
  const bool leavesAll = maxComponent(absolute(query.attenuation)) <=
                         kRounding * maxComponent(query.largestAttenuation);
  if (!std::isfinite(ray.tMax) && !leavesAll) return query.transmittance;
  return query.transmittance * glm::exp(-glm::max(query.opticalDepth, Rgb(0)));
}

EmbreeVersion embreeVersion() {
  const RTCDevice device = rtcNewDevice(nullptr);
  if (!device) throwRun("Embree does not start: error {}", int(rtcGetDeviceError(nullptr)));
  const auto get = [&](RTCDeviceProperty property) {
    return int(rtcGetDeviceProperty(device, property));
  };
  const EmbreeVersion found{
      fmt::format("{}.{}.{}", get(RTC_DEVICE_PROPERTY_VERSION_MAJOR),
                  get(RTC_DEVICE_PROPERTY_VERSION_MINOR), get(RTC_DEVICE_PROPERTY_VERSION_PATCH)),
      get(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)  ? 16
      : get(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? 8
                                                       : 4};
  rtcReleaseDevice(device);
  return found;
}

}  // namespace chromeball
