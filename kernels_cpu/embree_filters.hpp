// Which of the hits that Embree finds count: those that alpha stops, that lie behind the surface
// whose alpha was asked for last, and of equally distant ones the first in the order of the scene.
// Included where embree_scene.cpp's own types are, after typed_views.hpp, in a namespace without
// a name: the types of the views differ from one kernel set to another.
#pragma once

using embree::RayHits;
using embree::Rays;
using embree::width;

constexpr float far_away = std::numeric_limits<float>::infinity();

// The views that the packets read and write, with their types.
struct Views {
    Scene scene;
    Paths paths;
};

Views typed(const SceneView& scene, const PathView& paths)
{
    return {scene_from(scene), paths_from(paths)};
}

// What filters need of the rays of a packet.
struct PacketContext {
    embree::Query query;  // first: Embree hands its address back
    const Views* views;
    const int* first_triangle;  // by instance
    int path[width];
    int purpose;
    // The best hit so far of each ray of the packet: its distance, then instance and triangle.
    float best_distance[width];
    std::uint64_t best_place[width];
    // Where textures give the alpha of surfaces: behind which each ray goes on, whether it is after
    // these surfaces alone, and whether the way of a shadow ray holds any.
    float passed_distance[width];
    std::uint64_t passed_place[width];
    bool leaves_records = false;
    bool seeks_asked = false;
    bool has_asked[width];
};

int instance_of(unsigned embree_instance)
{
    return embree_instance == RTC_INVALID_GEOMETRY_ID ? 0 : int(embree_instance);
}

// The order of hits at equal distance: the world's triangles first.
std::uint64_t place_of(std::uint64_t instance, std::uint64_t triangle_of_mesh)
{
    return (instance == 0 ? 0 : instance + 1) << 32 | triangle_of_mesh;
}

// Alpha: hits that let the ray through are not hits.
void filter_alpha(const RTCFilterFunctionNArguments* arguments)
{
    const auto* context = reinterpret_cast<const PacketContext*>(arguments->context);
    const unsigned n = arguments->N;
    for (unsigned k = 0; k < n; ++k) {
        if (arguments->valid[k] != -1) continue;
        const int instance = instance_of(RTCHitN_instID(arguments->hit, n, k, 0));
        const int triangle =
            context->first_triangle[instance] + int(RTCHitN_primID(arguments->hit, n, k));
        const int i = context->path[RTCRayN_id(arguments->ray, n, k)];
        const Scene* scene = &context->views->scene;
        const Paths* paths = &context->views->paths;
        const uint seed = alpha_seed(scene->settings[0].seed, get_pixel(paths, i),
                                     get_sample(paths, i), get_depth(paths, i), context->purpose);
        const float u = RTCHitN_u(arguments->hit, n, k);
        const float v = RTCHitN_v(arguments->hit, n, k);
        if (!alpha_accepts(scene, instance, triangle, u, v, seed)) arguments->valid[k] = 0;
    }
}

// Of hits at equal distance the one with the smaller instance and triangle counts, so that what a
// ray hits does not depend on the order in which Embree meets it, nor on the packet's other rays.
void filter_ties(const RTCFilterFunctionNArguments* arguments)
{
    auto* context = reinterpret_cast<PacketContext*>(arguments->context);
    const unsigned n = arguments->N;
    for (unsigned k = 0; k < n; ++k) {
        if (arguments->valid[k] != -1) continue;
        const unsigned lane = RTCRayN_id(arguments->ray, n, k);
        const float distance = RTCRayN_tfar(arguments->ray, n, k);
        const std::uint64_t instance = RTCHitN_instID(arguments->hit, n, k, 0) + 1u;  // world: 0
        const std::uint64_t place = instance << 32 | RTCHitN_primID(arguments->hit, n, k);
        const float best = context->best_distance[lane];
        if (distance < best || (distance == best && place < context->best_place[lane])) {
            context->best_distance[lane] = distance;
            context->best_place[lane] = place;
        } else {
            arguments->valid[k] = 0;
        }
    }
}

void filter_alpha_then_ties(const RTCFilterFunctionNArguments* arguments)
{
    filter_alpha(arguments);
    filter_ties(arguments);
}

bool is_asked(const PacketContext& context, const RTCFilterFunctionNArguments* arguments,
              unsigned k)
{
    const int instance = instance_of(RTCHitN_instID(arguments->hit, arguments->N, k, 0));
    const unsigned triangle = RTCHitN_primID(arguments->hit, arguments->N, k);
    return alpha_is_asked(&context.views->scene, context.first_triangle[instance] + int(triangle));
}

// What lies behind the surface that the ray has passed last. A ray meets no triangle twice,
// whatever the rounding of another packet's arithmetic makes of its distance.
void filter_passed(const RTCFilterFunctionNArguments* arguments)
{
    const auto* context = reinterpret_cast<const PacketContext*>(arguments->context);
    const unsigned n = arguments->N;
    for (unsigned k = 0; context->leaves_records && k < n; ++k) {
        if (arguments->valid[k] != -1) continue;
        const unsigned lane = RTCRayN_id(arguments->ray, n, k);
        const float distance = RTCRayN_tfar(arguments->ray, n, k);
        const int instance = instance_of(RTCHitN_instID(arguments->hit, n, k, 0));
        const std::uint64_t place =
            place_of(std::uint64_t(instance), RTCHitN_primID(arguments->hit, n, k));
        const float passed = context->passed_distance[lane];
        const std::uint64_t last = context->passed_place[lane];
        const bool is_behind = distance > passed || (distance == passed && place > last);
        const bool is_wanted = !context->seeks_asked || is_asked(*context, arguments, k);
        if (!is_behind || (passed > 0 && place == last) || !is_wanted) arguments->valid[k] = 0;
    }
}

void filter_passed_then_alpha(const RTCFilterFunctionNArguments* arguments)
{
    filter_passed(arguments);
    filter_alpha_then_ties(arguments);
}

// Shadow rays: surfaces about which a texture has to be asked stop none yet. Where there are no
// records to ask by, they do.
void filter_asked_then_alpha(const RTCFilterFunctionNArguments* arguments)
{
    auto* context = reinterpret_cast<PacketContext*>(arguments->context);
    for (unsigned k = 0; context->leaves_records && k < arguments->N; ++k) {
        if (arguments->valid[k] != -1 || !is_asked(*context, arguments, k)) continue;
        context->has_asked[RTCRayN_id(arguments->ray, arguments->N, k)] = true;
        arguments->valid[k] = 0;
    }
    filter_alpha(arguments);
}

// Begins a query for path i in a lane: from the start, or behind the record of the path. Returns
// the distance from which on hits matter, a little less than the record's.
float begin_lane(PacketContext& context, const Paths& paths, int lane, int i, bool is_alive)
{
    context.path[lane] = i;
    context.best_distance[lane] = far_away;
    context.best_place[lane] = ~std::uint64_t(0);
    if (!context.leaves_records) return 0;
    context.passed_distance[lane] = 0;
    context.passed_place[lane] = 0;
    if (paths.lookup == LOOKUP_SURFACE || !is_alive) return 0;
    const int instance = paths.record_instance[i];
    context.passed_distance[lane] = paths.record_distance[i];
    context.passed_place[lane] =
        place_of(std::uint64_t(instance),
                 std::uint64_t(paths.record_triangle[i] - context.first_triangle[instance]));
    return paths.record_distance[i] * 0.99999f;
}
