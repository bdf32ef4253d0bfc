// Affine transforms in double precision: placements are composed and applied with them before
// anything is rounded to float.
#pragma once

#include <array>
#include <cmath>

namespace diptych {

using Vec3 = std::array<double, 3>;

inline Vec3 operator+(const Vec3& a, const Vec3& b)
{
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vec3 operator-(const Vec3& a, const Vec3& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vec3 operator*(const Vec3& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
inline double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline double length(const Vec3& a) { return std::hypot(a[0], a[1], a[2]); }
inline Vec3 cross(const Vec3& a, const Vec3& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
// Zero stays zero.
inline Vec3 unit(const Vec3& a)
{
    const double size = length(a);
    return size > 0 ? a * (1 / size) : a;
}

// world = row * (x, y, z, 1), the last row of the 4x4 matrix being 0 0 0 1.
struct Transform {
    std::array<std::array<double, 4>, 3> row{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

    Vec3 point(const Vec3& p) const { return vector(p) + Vec3{row[0][3], row[1][3], row[2][3]}; }
    Vec3 vector(const Vec3& v) const
    {
        Vec3 result{};
        for (int i = 0; i < 3; ++i) {
            result[i] = row[i][0] * v[0] + row[i][1] * v[1] + row[i][2] * v[2];
        }
        return result;
    }
    // The transpose of the linear part: normals of the object of which this is the inverse.
    Vec3 transposed_vector(const Vec3& v) const
    {
        Vec3 result{};
        for (int i = 0; i < 3; ++i) {
            result[i] = row[0][i] * v[0] + row[1][i] * v[1] + row[2][i] * v[2];
        }
        return result;
    }
    double determinant() const
    {
        return dot({row[0][0], row[0][1], row[0][2]},
                   cross({row[1][0], row[1][1], row[1][2]}, {row[2][0], row[2][1], row[2][2]}));
    }
    bool is_identity() const { return row == Transform{}.row; }
    bool is_finite() const
    {
        for (const auto& r : row) {
            for (const double x : r) {
                if (!std::isfinite(x)) {
                    return false;
                }
            }
        }
        return true;
    }
};

// First b, then a.
inline Transform operator*(const Transform& a, const Transform& b)
{
    Transform result;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 4; ++j) {
            result.row[i][j] = (j == 3 ? a.row[i][3] : 0) + a.row[i][0] * b.row[0][j] +
                               a.row[i][1] * b.row[1][j] + a.row[i][2] * b.row[2][j];
        }
    }
    return result;
}

// Not finite when the determinant is zero.
inline Transform inverse(const Transform& t)
{
    const double scale = 1 / t.determinant();
    Transform result;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            const int r0 = (j + 1) % 3, r1 = (j + 2) % 3, c0 = (i + 1) % 3, c1 = (i + 2) % 3;
            result.row[i][j] =
                (t.row[r0][c0] * t.row[r1][c1] - t.row[r0][c1] * t.row[r1][c0]) * scale;
        }
    }
    const Vec3 offset = result.vector({t.row[0][3], t.row[1][3], t.row[2][3]});
    for (int i = 0; i < 3; ++i) {
        result.row[i][3] = -offset[i];
    }
    return result;
}

inline Transform translation(double x, double y, double z)
{
    Transform result;
    result.row[0][3] = x;
    result.row[1][3] = y;
    result.row[2][3] = z;
    return result;
}

inline Transform scaling(double x, double y, double z)
{
    Transform result;
    result.row[0][0] = x;
    result.row[1][1] = y;
    result.row[2][2] = z;
    return result;
}

// From a quaternion (x, y, z, w), normalised here; the zero quaternion does not rotate.
inline Transform rotation(double x, double y, double z, double w)
{
    const double size = std::sqrt(x * x + y * y + z * z + w * w);
    Transform result;
    if (!(size > 0)) {
        return result;
    }
    x /= size, y /= size, z /= size, w /= size;
    result.row = {{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 0},
                   {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), 0},
                   {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), 0}}};
    return result;
}

// About a unit axis, counter-clockwise seen from its tip; radians.
inline Transform rotation_about(const Vec3& axis, double angle)
{
    const double s = std::sin(angle / 2);
    return rotation(axis[0] * s, axis[1] * s, axis[2] * s, std::cos(angle / 2));
}

}  // namespace diptych
