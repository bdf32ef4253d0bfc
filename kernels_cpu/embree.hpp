// Embree 3 or 4, whichever the distribution has, asked in one way: the only place that knows which.
// They differ in what a query is given beside its rays; with both, filters get the address of the
// Query, so that what stands behind it in a structure is theirs to read.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace diptych::embree {

// Packets hold as many rays as the processor's vectors hold floats.
#if defined(__AVX512F__)
constexpr int width = 16;
using RayHits = RTCRayHit16;
using Rays = RTCRay16;
constexpr auto intersect_packet = rtcIntersect16;
constexpr auto occlude_packet = rtcOccluded16;
#else
constexpr int width = 8;
using RayHits = RTCRayHit8;
using Rays = RTCRay8;
constexpr auto intersect_packet = rtcIntersect8;
constexpr auto occlude_packet = rtcOccluded8;
#endif

#if RTC_VERSION_MAJOR >= 4

struct Query {
    RTCRayQueryContext context;  // first: its address is what filters get
    RTCRayQueryFlags flags;
};

// is_coherent: whether the rays have much of their way in common.
inline Query begin_query(bool is_coherent)
{
    Query query;
    rtcInitRayQueryContext(&query.context);
    query.flags = is_coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    return query;
}

inline RTCIntersectArguments intersect_arguments(Query& query)
{
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = query.flags;
    arguments.context = &query.context;
    return arguments;
}

inline void intersect(RTCScene scene, Query& query, RTCRayHit& ray)
{
    RTCIntersectArguments arguments = intersect_arguments(query);
    rtcIntersect1(scene, &ray, &arguments);
}

// valid: -1 for the lanes that count, 0 for the others.
inline void intersect(const int* valid, RTCScene scene, Query& query, RayHits& rays)
{
    RTCIntersectArguments arguments = intersect_arguments(query);
    intersect_packet(valid, scene, &rays, &arguments);
}

// Leaves a negative tfar in the rays that are stopped.
inline void occlude(const int* valid, RTCScene scene, Query& query, Rays& rays)
{
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = query.flags;
    arguments.context = &query.context;
    occlude_packet(valid, scene, &rays, &arguments);
}

#else

using Query = RTCIntersectContext;

// is_coherent: whether the rays have much of their way in common.
inline Query begin_query(bool is_coherent)
{
    Query query;
    rtcInitIntersectContext(&query);
    query.flags =
        is_coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return query;
}

inline void intersect(RTCScene scene, Query& query, RTCRayHit& ray)
{
    rtcIntersect1(scene, &query, &ray);
}

// valid: -1 for the lanes that count, 0 for the others.
inline void intersect(const int* valid, RTCScene scene, Query& query, RayHits& rays)
{
    intersect_packet(valid, scene, &query, &rays);
}

// Leaves a negative tfar in the rays that are stopped.
inline void occlude(const int* valid, RTCScene scene, Query& query, Rays& rays)
{
    occlude_packet(valid, scene, &query, &rays);
}

#endif

}  // namespace diptych::embree
