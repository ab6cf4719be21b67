/// The one thin place where Embree 3.13 and 4 differ: ray queries with a context of our own. Rays alone, or
/// 16 in a packet, whose lanes count where `valid` is -1.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace parian {

#if RTC_VERSION_MAJOR >= 4
struct EmbreeContext : RTCRayQueryContext {
  RTCRayQueryFlags flags;
};
/// `coherent`: the rays of a packet run along each other.
inline void init_context(EmbreeContext& context, bool coherent) {
  rtcInitRayQueryContext(&context);
  context.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
}
inline RTCIntersectArguments intersect_arguments(EmbreeContext& context) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  arguments.flags = context.flags;
  return arguments;
}
inline RTCOccludedArguments occluded_arguments(EmbreeContext& context) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  arguments.flags = context.flags;
  return arguments;
}
/// What a scene must be told for embree_visit().
inline constexpr RTCSceneFlags kVisitable = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
/// Shows a filter everything that the ray meets, after the geometries' own filters.
inline void embree_visit(RTCScene scene, RTCRayHit& ray, EmbreeContext& context, RTCFilterFunctionN filter) {
  RTCIntersectArguments arguments = intersect_arguments(context);
  arguments.filter = filter;
  arguments.flags = RTCRayQueryFlags(arguments.flags | RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER);
  rtcIntersect1(scene, &ray, &arguments);
}
inline void embree_intersect(RTCScene scene, RTCRayHit& ray, EmbreeContext& context) {
  RTCIntersectArguments arguments = intersect_arguments(context);
  rtcIntersect1(scene, &ray, &arguments);
}
inline void embree_occluded(RTCScene scene, RTCRay& ray, EmbreeContext& context) {
  RTCOccludedArguments arguments = occluded_arguments(context);
  rtcOccluded1(scene, &ray, &arguments);
}
inline void embree_intersect(RTCScene scene, const int* valid, RTCRayHit16& rays, EmbreeContext& context) {
  RTCIntersectArguments arguments = intersect_arguments(context);
  rtcIntersect16(valid, scene, &rays, &arguments);
}
inline void embree_occluded(RTCScene scene, const int* valid, RTCRay16& rays, EmbreeContext& context) {
  RTCOccludedArguments arguments = occluded_arguments(context);
  rtcOccluded16(valid, scene, &rays, &arguments);
}
#else
/// What a scene must be told for embree_visit().
inline constexpr RTCSceneFlags kVisitable = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
using EmbreeContext = RTCIntersectContext;
/// `coherent`: the rays of a packet run along each other.
inline void init_context(EmbreeContext& context, bool coherent) {
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
}
/// Shows a filter everything that the ray meets, after the geometries' own filters.
inline void embree_visit(RTCScene scene, RTCRayHit& ray, EmbreeContext& context, RTCFilterFunctionN filter) {
  context.filter = filter;
  rtcIntersect1(scene, &context, &ray);
}
inline void embree_intersect(RTCScene scene, RTCRayHit& ray, EmbreeContext& context) {
  rtcIntersect1(scene, &context, &ray);
}
inline void embree_occluded(RTCScene scene, RTCRay& ray, EmbreeContext& context) {
  rtcOccluded1(scene, &context, &ray);
}
inline void embree_intersect(RTCScene scene, const int* valid, RTCRayHit16& rays, EmbreeContext& context) {
  rtcIntersect16(valid, scene, &context, &rays);
}
inline void embree_occluded(RTCScene scene, const int* valid, RTCRay16& rays, EmbreeContext& context) {
  rtcOccluded16(valid, scene, &context, &rays);
}
#endif

}  // namespace parian
