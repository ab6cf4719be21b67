/// The one thin place where Embree 3.13 and 4 differ: ray queries with a context of our own.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace parian {

#if RTC_VERSION_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
inline void init_context(EmbreeContext& context) { rtcInitRayQueryContext(&context); }

inline void embree_intersect(RTCScene scene, RTCRayHit& ray, EmbreeContext& context, bool coherent) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  arguments.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  rtcIntersect1(scene, &ray, &arguments);
}

inline void embree_occluded(RTCScene scene, RTCRay& ray, EmbreeContext& context) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  rtcOccluded1(scene, &ray, &arguments);
}
#else
using EmbreeContext = RTCIntersectContext;
inline void init_context(EmbreeContext& context) { rtcInitIntersectContext(&context); }

inline void embree_intersect(RTCScene scene, RTCRayHit& ray, EmbreeContext& context, bool coherent) {
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  rtcIntersect1(scene, &context, &ray);
}

inline void embree_occluded(RTCScene scene, RTCRay& ray, EmbreeContext& context) {
  rtcOccluded1(scene, &context, &ray);
}
#endif

}  // namespace parian
