// How bright the emitters are that a texture paints, from places spread over them: the share of
// light sampling that they get. What they emit is computed where it is needed; the estimate moves
// noise, never the mean.
#include "backends/textures/emission_lookup.hpp"
#include "host/scene/scene_assembly.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <span>

namespace diptych {
namespace {

constexpr size_t most_places = size_t(1) << 18;  // of all materials together
// Where all places were dark there may yet be light between them: as bright as this share of the
// factor, at least.
constexpr double least_share = 1.0 / 64;

struct Emitter {
    double area_before = 0;  // of the emitters of its material that come before it
    EmissionQuery head_on;   // from the first corner, along the normal
    Vec3 corner, edge1, edge2;
};

float3 to_float3(const Vec3& v) { return {float(v[0]), float(v[1]), float(v[2])}; }

Vec3 placed(const Instance& instance, const float4& p)
{
    const auto row = [&](const float4& r) {
        return double(r.x) * p.x + double(r.y) * p.y + double(r.z) * p.z + r.w;
    };
    return {row(instance.to_world_x), row(instance.to_world_y), row(instance.to_world_z)};
}

double fraction(double x) { return x - std::floor(x); }

// The emitters of one material.
struct PaintedArea {
    std::vector<Emitter> emitters;
    double area = 0;

    void add(const Instance& instance, int instance_id, int triangle_id, const float4* corners[3])
    {
        Emitter emitter;
        emitter.corner = placed(instance, *corners[0]);
        emitter.edge1 = placed(instance, *corners[1]) - emitter.corner;
        emitter.edge2 = placed(instance, *corners[2]) - emitter.corner;
        const Vec3 normal = cross(emitter.edge1, emitter.edge2);
        const Vec3 inward = unit(normal) * (instance.is_mirrored ? 1.0 : -1.0);
        emitter.head_on = {triangle_id, instance_id, {}, to_float3(inward)};
        emitter.area_before = area;
        area += 0.5 * length(normal);
        emitters.push_back(emitter);
    }

    // Place k of n, evenly spread over the area and looked at from in front: strata choose the
    // triangle, an additive recurrence the point (Roberts, "The Unreasonable Effectiveness of
    // Quasirandom Sequences", 2018).
    EmissionQuery place(size_t k, size_t n) const
    {
        const double at = (double(k) + 0.5) / double(n) * area;
        const auto behind = std::ranges::upper_bound(emitters, at, {}, &Emitter::area_before);
        const Emitter& emitter = *(behind - 1);
        double u = fraction(0.5 + double(k) * 0.7548776662466927);
        double v = fraction(0.5 + double(k) * 0.5698402909980532);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        EmissionQuery query = emitter.head_on;
        const Vec3 point = emitter.corner + emitter.edge1 * u + emitter.edge2 * v;
        const Vec3 inward{query.direction.x, query.direction.y, query.direction.z};
        query.origin = to_float3(point - inward * length(emitter.edge1));
        return query;
    }
};

std::array<double, 3> mean_of(std::span<const float4> texels, const std::array<double, 3>& factor)
{
    std::array<double, 3> sum{};
    for (const float4& texel : texels) {
        const float components[3] = {texel.x, texel.y, texel.z};
        for (size_t c = 0; c < 3; ++c)
            if (std::isfinite(components[c]) && components[c] > 0) sum[c] += components[c];
    }
    std::array<double, 3> mean{}, least{};
    for (size_t c = 0; c < 3; ++c) {
        mean[c] = factor[c] * sum[c] / double(texels.size());
        least[c] = factor[c] * least_share;
    }
    const bool is_dark =
        luminance(mean[0], mean[1], mean[2]) < luminance(least[0], least[1], least[2]);
    return is_dark ? least : mean;
}

}  // namespace

void SceneAssembly::estimate_emitters()
{
    if ((data_.effects & EFFECT_PROCEDURAL_EMISSION) == 0) return;
    std::map<int, PaintedArea> painted;  // by material
    for (size_t n = 0; n < data_.instances.size(); ++n) {
        const Instance& instance = data_.instances[n];
        for (int k = 0; k < instance.triangle_count; ++k) {
            const int id = instance.first_triangle + k;
            const Triangle& t = data_.triangles[size_t(id)];
            const Material& material = data_.materials[size_t(t.material)];
            if (material.texture_program[PROGRAM_EMISSION] == 0) continue;
            const float4* corners[3] = {&data_.positions[size_t(t.vertex0)],
                                        &data_.positions[size_t(t.vertex1)],
                                        &data_.positions[size_t(t.vertex2)]};
            painted[t.material].add(instance, int(n), id, corners);
        }
    }
    if (painted.empty()) return;
    const size_t each = std::clamp(most_places / painted.size(), size_t(64), size_t(1024));
    std::vector<EmissionQuery> queries;
    for (const auto& [material, surface] : painted)
        for (size_t k = 0; k < each; ++k) queries.push_back(surface.place(k, each));
    try {
        const std::vector<float4> texels = look_up_emission(data_, queries);
        size_t first = 0;
        for (const auto& [material, surface] : painted) {
            std::array<double, 3>& mean = mean_emission_[size_t(material)];
            mean = mean_of(std::span(texels).subspan(first, each), mean);
            first += each;
        }
    } catch (const std::runtime_error& error) {
        const std::string why = error.what();
        data_.notices.push_back(fmt::format("lights: the power of painted emitters is taken as if "
                                            "the textures gave 1: {}",
                                            why.substr(0, why.find('\n'))));
    }
}

}  // namespace diptych
