// SPDX-License-Identifier: Apache-2.0
// Hides the differences between Embree 3.13 and Embree 4.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace chromeball {

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
inline void rtcIntersect(RTCScene scene, const int* valid, RTCRayHit8& rays, bool coherent,
                         QueryContext& context) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  if (coherent) arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect8(valid, scene, &rays, &arguments);
}
inline void rtcOccluded(RTCScene scene, const int* valid, RTCRay8& rays, QueryContext& context) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  rtcOccluded8(valid, scene, &rays, &arguments);
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
inline void rtcIntersect(RTCScene scene, const int* valid, RTCRayHit8& rays, bool coherent,
                         QueryContext& context) {
  if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(valid, scene, &context, &rays);
}
inline void rtcOccluded(RTCScene scene, const int* valid, RTCRay8& rays, QueryContext& context) {
  rtcOccluded8(valid, scene, &context, &rays);
}
#endif

}  // namespace chromeball
