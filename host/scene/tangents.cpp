#include "host/scene/tangents.hpp"

#include <algorithm>

namespace diptych {
namespace {

Vec3 to_vec(const float3& v) { return {v.x, v.y, v.z}; }

// Any direction orthogonal to n, where the texture gives none.
Vec3 any_tangent(const Vec3& n)
{
    const Vec3 axis = std::abs(n[0]) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    return unit(axis - n * dot(n, axis));
}

struct Gradient {
    Vec3 along_u;   // not normalised; zero where the texture is degenerate
    bool is_right;  // cross(normal, along_u) points to the top of the image (-v)
};

Gradient texture_gradient(const std::array<Vec3, 3>& p,
                          const std::array<std::array<double, 2>, 3>& t)
{
    const Vec3 e1 = p[1] - p[0], e2 = p[2] - p[0];
    const double du1 = t[1][0] - t[0][0], dv1 = t[1][1] - t[0][1];
    const double du2 = t[2][0] - t[0][0], dv2 = t[2][1] - t[0][1];
    const double area = du1 * dv2 - du2 * dv1;
    if (area == 0 || !std::isfinite(area)) {
        return {{0, 0, 0}, true};
    }
    // Winding counter-clockwise in (u, -v), with v pointing down, is right-handed.
    return {unit((e1 * dv2 - e2 * dv1) * (area > 0 ? 1 : -1)), area < 0};
}

double corner_angle(const Vec3& from, const Vec3& a, const Vec3& b)
{
    const Vec3 to_a = unit(a - from), to_b = unit(b - from);
    return std::acos(std::clamp(dot(to_a, to_b), -1.0, 1.0));
}

// A second copy of vertex v in every array.
uint duplicate_vertex(MeshPart& part, uint v)
{
    part.positions.push_back(float3(part.positions[v]));
    if (!part.normals.empty()) {
        part.normals.push_back(float3(part.normals[v]));
    }
    if (!part.colors.empty()) {
        part.colors.push_back(float4(part.colors[v]));
    }
    for (auto& set : part.uvs) {
        if (!set.empty()) {
            set.push_back(float2(set[v]));
        }
    }
    return uint(part.positions.size() - 1);
}

// Gives vertices with corners of both hands a copy for the left-handed ones.
void split_mixed_vertices(MeshPart& part, const std::vector<char>& triangle_right,
                          std::vector<char>& vertex_right)
{
    const size_t vertex_count = part.positions.size();
    std::vector<char> seen(vertex_count, 0);  // bit 0: right-handed corners, bit 1: left-handed
    for (size_t c = 0; c < part.indices.size(); ++c) {
        seen[part.indices[c]] |= triangle_right[c / 3] ? 1 : 2;
    }
    vertex_right.assign(vertex_count, 1);
    std::vector<uint> copy(vertex_count);
    for (uint v = 0; v < vertex_count; ++v) {
        if (seen[v] == 2) {
            vertex_right[v] = 0;
        }
        if (seen[v] == 3) {
            copy[v] = duplicate_vertex(part, v);
            vertex_right.push_back(0);
        }
    }
    for (size_t c = 0; c < part.indices.size(); ++c) {
        const uint v = part.indices[c];
        if (seen[v] == 3 && !triangle_right[c / 3]) {
            part.indices[c] = copy[v];
        }
    }
}

}  // namespace

void derive_tangents(MeshPart& part, const TextureUse& use)
{
    const size_t set = size_t(use.uv_set);
    const size_t triangle_count = part.indices.size() / 3;
    const auto image_uv = [&](uint v) -> std::array<double, 2> {
        if (set >= part.uvs.size() || part.uvs[set].empty()) {
            return {0, 0};
        }
        const float2 uv = part.uvs[set][v];
        const auto& m = use.to_uv;
        return {m[0][0] * uv.x + m[0][1] * uv.y + m[0][2],
                m[1][0] * uv.x + m[1][1] * uv.y + m[1][2]};
    };
    const auto gradient_of = [&](size_t t) {
        std::array<Vec3, 3> p;
        std::array<std::array<double, 2>, 3> uv;
        for (int k = 0; k < 3; ++k) {
            p[k] = to_vec(part.positions[part.indices[3 * t + k]]);
            uv[k] = image_uv(part.indices[3 * t + k]);
        }
        return texture_gradient(p, uv);
    };

    std::vector<char> triangle_right(triangle_count), vertex_right;
    for (size_t t = 0; t < triangle_count; ++t) {
        triangle_right[t] = gradient_of(t).is_right;
    }
    split_mixed_vertices(part, triangle_right, vertex_right);

    std::vector<Vec3> sums(part.positions.size(), Vec3{0, 0, 0});
    for (size_t t = 0; t < triangle_count; ++t) {
        const Vec3 along_u = gradient_of(t).along_u;
        const uint* v = &part.indices[3 * t];
        for (int k = 0; k < 3; ++k) {
            const Vec3 p = to_vec(part.positions[v[k]]), n = unit(to_vec(part.normals[v[k]]));
            // The angle between the edges as seen along the normal.
            const auto flat = [&](const Vec3& q) { return q - n * dot(n, q - p); };
            const double angle = corner_angle(p, flat(to_vec(part.positions[v[(k + 1) % 3]])),
                                              flat(to_vec(part.positions[v[(k + 2) % 3]])));
            sums[v[k]] = sums[v[k]] + unit(along_u - n * dot(n, along_u)) * angle;
        }
    }
    part.tangents.resize(part.positions.size());
    for (size_t v = 0; v < sums.size(); ++v) {
        const Vec3 n = unit(to_vec(part.normals[v]));
        const Vec3 t = length(sums[v]) > 1e-12 ? unit(sums[v]) : any_tangent(n);
        part.tangents[v] = {float(t[0]), float(t[1]), float(t[2]), vertex_right[v] ? 1.0f : -1.0f};
    }
}

}  // namespace diptych
