// The arithmetic that works in any precision: what OpenCL and C leave to the runtime's rounding
// (dot, length, normalize, mix, fmin of a NaN, conversions out of range) is written out here, in a
// fixed order, so that all backends agree. Selects only.
#pragma once

// The other operand if one is NaN, as C99's fmin and fmax; of two zeros, the second.
SHARED float math_min(float a, float b) { return a < b ? a : (b == b ? b : a); }
SHARED float math_max(float a, float b) { return a > b ? a : (b == b ? b : a); }

// The same in one comparison, for kernels: the second operand if either is NaN.
SHARED float math_lesser(float a, float b) { return a < b ? a : b; }
SHARED float math_greater(float a, float b) { return a > b ? a : b; }

// `low` if x is NaN.
SHARED float math_clamp(float x, float low, float high)
{
    const float above = x > low ? x : low;
    return above < high ? above : high;
}

SHARED float math_lerp(float a, float b, float t) { return a * (1.0f - t) + b * t; }

// Towards zero; clamped to the range of int, 0 for NaN.
SHARED int float_to_int(float x)
{
    const int is_above = x >= 2147483648.0f;
    const int is_below = x <= -2147483648.0f;
    const float inside = math_abs(x) < 2147483648.0f ? x : 0.0f;
    const int value = (int)inside;
    return is_above ? 2147483647 : (is_below ? -2147483647 - 1 : value);
}

// The upper half of the product. In halves, because vector units multiply 32 bits by 32 to 32.
SHARED uint multiply_high(uint x, uint y)
{
    const uint x_low = x & 0xffffu;
    const uint y_low = y & 0xffffu;
    const uint inner = (x >> 16) * y_low + ((x_low * y_low) >> 16);
    const uint outer = x_low * (y >> 16) + (inner & 0xffffu);
    return (x >> 16) * (y >> 16) + (inner >> 16) + (outer >> 16);
}

SHARED float3 select3(int condition, float3 a, float3 b)
{
    return make_float3(condition ? a.x : b.x, condition ? a.y : b.y, condition ? a.z : b.z);
}

SHARED float vec_dot(float3 a, float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

SHARED float3 vec_cross(float3 a, float3 b)
{
    return make_float3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

SHARED float vec_length(float3 v) { return math_sqrt(vec_dot(v, v)); }

// Unit length; zero stays zero. For lengths between 1e-18 and 1e18, whose squares are normal
// floats.
SHARED float3 vec_normalize(float3 v)
{
    const float length = vec_length(v);
    return v * (1.0f / (length > 0.0f ? length : 1.0f));
}

// a at t = 0, b at t = 1, exactly.
SHARED float3 vec_lerp(float3 a, float3 b, float t) { return a * (1.0f - t) + b * t; }

// The mirror image of a direction v that leaves the surface, about the unit normal n.
SHARED float3 vec_reflect(float3 v, float3 n) { return n * (2.0f * vec_dot(v, n)) - v; }

SHARED float3 vec_abs(float3 v) { return make_float3(math_abs(v.x), math_abs(v.y), math_abs(v.z)); }
SHARED float3 vec_min(float3 a, float3 b)
{
    return make_float3(math_min(a.x, b.x), math_min(a.y, b.y), math_min(a.z, b.z));
}
SHARED float3 vec_max(float3 a, float3 b)
{
    return make_float3(math_max(a.x, b.x), math_max(a.y, b.y), math_max(a.z, b.z));
}
SHARED float vec_max_component(float3 v) { return math_greater(math_greater(v.x, v.y), v.z); }
SHARED float vec_min_component(float3 v) { return math_min(math_min(v.x, v.y), v.z); }

// Of a linear Rec.709 colour.
SHARED float vec_luminance(float3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

// No component is infinite or NaN.
SHARED int vec_is_finite(float3 v)
{
    const int x = math_abs(v.x) <= FLOAT_MAX;
    const int y = math_abs(v.y) <= FLOAT_MAX;
    const int z = math_abs(v.z) <= FLOAT_MAX;
    return x & y & z;
}

// A right-handed frame (tangent, bitangent, n) about a unit vector, without a branch, by Duff et
// al., "Building an Orthonormal Basis, Revisited" (JCGT 2017).
SHARED float3 frame_tangent(float3 n)
{
    const float sign = n.z >= 0.0f ? 1.0f : -1.0f;
    const float a = -1.0f / (sign + n.z);
    return make_float3(1.0f + sign * n.x * n.x * a, sign * (n.x * n.y * a), -sign * n.x);
}
SHARED float3 frame_bitangent(float3 n)
{
    const float sign = n.z >= 0.0f ? 1.0f : -1.0f;
    const float a = -1.0f / (sign + n.z);
    return make_float3(n.x * n.y * a, sign + n.y * n.y * a, -n.y);
}

// A fraction in [-1, 1] as a 16-bit integer.
SHARED uint snorm16_pack(float x)
{
    return (uint)(int)math_floor(math_clamp(x, -1.0f, 1.0f) * 32767.0f + 0.5f) & 0xffffu;
}
SHARED float snorm16_unpack(uint bits)
{
    return (float)((int)(bits << 16) >> 16) * 3.05185094e-05f;
}

// A direction in 32 bits: the octahedron |x| + |y| + |z| = 1, its lower half folded over the upper,
// as two 16-bit fractions; off by at most 7e-5 rad. v need not have unit length; zero becomes +z.
SHARED uint normal_pack(float3 v)
{
    const float sum = math_abs(v.x) + math_abs(v.y) + math_abs(v.z);
    const float scale = 1.0f / (sum > 0.0f ? sum : 1.0f);
    const float x = v.x * scale;
    const float y = v.y * scale;
    const float folded_x = (1.0f - math_abs(y)) * (x >= 0.0f ? 1.0f : -1.0f);
    const float folded_y = (1.0f - math_abs(x)) * (y >= 0.0f ? 1.0f : -1.0f);
    const int is_lower = v.z < 0.0f;
    return snorm16_pack(is_lower ? folded_x : x) | snorm16_pack(is_lower ? folded_y : y) << 16;
}

// Unit length.
SHARED float3 normal_unpack(uint bits)
{
    const float x = snorm16_unpack(bits);
    const float y = snorm16_unpack(bits >> 16);
    const float z = 1.0f - math_abs(x) - math_abs(y);
    const float fold = z < 0.0f ? -z : 0.0f;
    return vec_normalize(
        make_float3(x + (x >= 0.0f ? -fold : fold), y + (y >= 0.0f ? -fold : fold), z));
}
