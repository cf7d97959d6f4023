// Embree 3 or 4, whose calls for rays differ.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace astrolith {

#if RTC_VERSION_MAJOR >= 4
inline void intersect_ray(RTCScene scene, RTCRayHit& query) { rtcIntersect1(scene, &query); }
inline void occlude_ray(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray); }
#else
inline void intersect_ray(RTCScene scene, RTCRayHit& query) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &query);
}
inline void occlude_ray(RTCScene scene, RTCRay& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
}
#endif

}  // namespace astrolith
