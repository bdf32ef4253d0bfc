#include "host/scene/scene_builder.hpp"

#include <algorithm>
#include <numbers>

namespace diptych {
namespace {

float3 to_float3(const Vec3& v) { return {float(v[0]), float(v[1]), float(v[2])}; }

void append(MeshPart& part, const MeshPart& more)
{
    const uint first = uint(part.positions.size());
    part.positions.insert(part.positions.end(), more.positions.begin(), more.positions.end());
    part.uvs[0].insert(part.uvs[0].end(), more.uvs[0].begin(), more.uvs[0].end());
    for (const uint v : more.indices) {
        part.indices.push_back(first + v);
    }
}

}  // namespace

MeshPart quad_mesh(const Vec3& origin, const Vec3& edge_u, const Vec3& edge_v, int material)
{
    MeshPart part;
    for (const Vec3& corner :
         {origin, origin + edge_u, origin + edge_u + edge_v, origin + edge_v}) {
        part.positions.push_back(to_float3(corner));
    }
    part.uvs = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    part.indices = {0, 1, 2, 0, 2, 3};
    part.material = material;
    return part;
}

MeshPart box_mesh(const Vec3& low, const Vec3& high, int material)
{
    const Vec3 x{high[0] - low[0], 0, 0}, y{0, high[1] - low[1], 0}, z{0, 0, high[2] - low[2]};
    MeshPart part = quad_mesh(low, y, x, material);  // facing -z
    append(part, quad_mesh(low, z, y));              // -x
    append(part, quad_mesh(low, x, z));              // -y
    append(part, quad_mesh(high, x * -1, y * -1));   // +z
    append(part, quad_mesh(high, y * -1, z * -1));   // +x
    append(part, quad_mesh(high, z * -1, x * -1));   // +y
    return part;
}

MeshPart sphere_mesh(const Vec3& centre, double radius, int segments, int material)
{
    using std::numbers::pi;
    const int columns = std::max(segments, 3), rows = std::max(segments / 2, 2);
    MeshPart part;
    part.material = material;
    part.uvs.resize(1);
    for (int row = 0; row <= rows; ++row) {
        for (int column = 0; column <= columns; ++column) {
            const double polar = pi * row / rows;
            // The seam's two columns lie at exactly the same points.
            const double around = 2 * pi * (column % columns) / columns;
            // Exactly zero at the poles, where sin(pi) is not.
            const double ring = row == 0 || row == rows ? 0 : std::sin(polar);
            const Vec3 n{ring * std::cos(around), std::cos(polar), -ring * std::sin(around)};
            part.positions.push_back(to_float3(centre + n * radius));
            part.normals.push_back(to_float3(n));
            part.uvs[0].push_back({float(double(column) / columns), float(double(row) / rows)});
        }
    }
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const uint a = uint(row * (columns + 1) + column), b = a + uint(columns) + 1;
            if (row > 0) {
                part.indices.insert(part.indices.end(), {a, b, a + 1});
            }
            if (row < rows - 1) {
                part.indices.insert(part.indices.end(), {a + 1, b, b + 1});
            }
        }
    }
    return part;
}

}  // namespace diptych
