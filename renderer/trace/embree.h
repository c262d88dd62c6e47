// SPDX-License-Identifier: Apache-2.0
// Hides the differences between Embree 3.13 and Embree 4.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace chromeball {

// Packets of rays, by their width.
template <size_t kRays>
struct PacketOf;
template <>
struct PacketOf<8> {
  using Rays = RTCRay8;
  using RayHits = RTCRayHit8;
  static constexpr auto intersect = &rtcIntersect8;
  static constexpr auto occluded = &rtcOccluded8;
};
template <>
struct PacketOf<16> {
  using Rays = RTCRay16;
  using RayHits = RTCRayHit16;
  static constexpr auto intersect = &rtcIntersect16;
  static constexpr auto occluded = &rtcOccluded16;
};

// The context that Embree passes to the filter functions.
#if RTC_VERSION_MAJOR >= 4
using QueryContext = RTCRayQueryContext;
inline void initQueryContext(QueryContext& context) { rtcInitRayQueryContext(&context); }

inline void rtcIntersect(RTCScene scene, RTCRayHit& ray, QueryContext& context) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  arguments.feature_mask = RTC_FEATURE_FLAG_ALL;
  rtcIntersect1(scene, &ray, &arguments);
}
inline void rtcOccluded(RTCScene scene, RTCRay& ray, QueryContext& context) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  rtcOccluded1(scene, &ray, &arguments);
}
template <class Packet>
void intersectPacket(RTCScene scene, const int* valid, typename Packet::RayHits& rays,
                     bool coherent, QueryContext& context) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  if (coherent) arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  Packet::intersect(valid, scene, &rays, &arguments);
}
template <class Packet>
void occludePacket(RTCScene scene, const int* valid, typename Packet::Rays& rays,
                   QueryContext& context) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  Packet::occluded(valid, scene, &rays, &arguments);
}
#else
using QueryContext = RTCIntersectContext;
inline void initQueryContext(QueryContext& context) { rtcInitIntersectContext(&context); }

inline void rtcIntersect(RTCScene scene, RTCRayHit& ray, QueryContext& context) {
  rtcIntersect1(scene, &context, &ray);
}
inline void rtcOccluded(RTCScene scene, RTCRay& ray, QueryContext& context) {
  rtcOccluded1(scene, &context, &ray);
}
template <class Packet>
void intersectPacket(RTCScene scene, const int* valid, typename Packet::RayHits& rays,
                     bool coherent, QueryContext& context) {
  if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  Packet::intersect(valid, scene, &context, &rays);
}
template <class Packet>
void occludePacket(RTCScene scene, const int* valid, typename Packet::Rays& rays,
                   QueryContext& context) {
  Packet::occluded(valid, scene, &context, &rays);
}
#endif

}  // namespace chromeball
