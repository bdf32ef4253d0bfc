// Simplex noise of Perlin, "Noise hardware" (2001): one gradient at each corner of the triangle or
// tetrahedron around p, faded by (1/2 - r^2)^4, which ends before the next simplex begins, so that
// value and first derivatives are continuous. Values in [-1, 1], mean 0, zero at the corners.

float simplex_corner2(uint h, float x, float y)
{
    const float t = fmax(0.5f - x * x - y * y, 0.0f);
    return t * t * t * t * octagon_gradient2(h, x, y);
}

float simplex2_seeded(float2 p, uint seed)
{
    const float skew = (p.x + p.y) * 0.366025404f;
    const float x0 = floor(p.x + skew);
    const float y0 = floor(p.y + skew);
    const float unskew = (x0 + y0) * 0.211324865f;
    const float x = p.x - (x0 - unskew);
    const float y = p.y - (y0 - unskew);
    const int is_lower = x > y;
    const float step_x = is_lower ? 1.0f : 0.0f;
    const float step_y = 1.0f - step_x;
    const uint s = hash_scramble(seed);
    const uint sum = lattice_sum2((int)x0, (int)y0);
    const uint middle = sum + (is_lower ? lattice_sum2(1, 0) : lattice_sum2(0, 1));
    const float a = simplex_corner2(hash_scramble(sum ^ s), x, y);
    const float b = simplex_corner2(hash_scramble(middle ^ s), x - step_x + 0.211324865f,
                                    y - step_y + 0.211324865f);
    const float c = simplex_corner2(hash_scramble((sum + lattice_sum2(1, 1)) ^ s),
                                    x - 0.577350269f, y - 0.577350269f);
    return 99.2f * (a + b + c);
}

float simplex2(float2 p)
{
    return simplex2_seeded(p, 0u);
}

float simplex_corner3(uint h, float x, float y, float z)
{
    const float t = fmax(0.5f - x * x - y * y - z * z, 0.0f);
    return t * t * t * t * edge_gradient3(h, x, y, z);
}

// The tetrahedron's corners are passed in the order in which x, y, z are largest.
float simplex3_seeded(float3 p, uint seed)
{
    const float skew = (p.x + p.y + p.z) * 0.333333333f;
    const float x0 = floor(p.x + skew);
    const float y0 = floor(p.y + skew);
    const float z0 = floor(p.z + skew);
    const float unskew = (x0 + y0 + z0) * 0.166666667f;
    const float x = p.x - (x0 - unskew);
    const float y = p.y - (y0 - unskew);
    const float z = p.z - (z0 - unskew);
    const int xy = x >= y ? 1 : 0;
    const int yz = y >= z ? 1 : 0;
    const int zx = z > x ? 1 : 0;
    const int ax = xy & (1 - zx);
    const int ay = yz & (1 - xy);
    const int az = zx & (1 - yz);
    const int bx = xy | (1 - zx);
    const int by = yz | (1 - xy);
    const int bz = zx | (1 - yz);
    const uint s = hash_scramble(seed);
    const uint sum = lattice_sum3((int)x0, (int)y0, (int)z0);
    const uint sum_a = sum + lattice_sum3(ax, ay, az);
    const uint sum_b = sum + lattice_sum3(bx, by, bz);
    const uint sum_c = sum + lattice_sum3(1, 1, 1);
    const float v0 = simplex_corner3(hash_scramble(sum ^ s), x, y, z);
    const float va = simplex_corner3(hash_scramble(sum_a ^ s), x - (float)ax + 0.166666667f,
                                     y - (float)ay + 0.166666667f, z - (float)az + 0.166666667f);
    const float vb = simplex_corner3(hash_scramble(sum_b ^ s), x - (float)bx + 0.333333333f,
                                     y - (float)by + 0.333333333f, z - (float)bz + 0.333333333f);
    const float vc = simplex_corner3(hash_scramble(sum_c ^ s), x - 0.5f, y - 0.5f, z - 0.5f);
    return 76.8f * (v0 + va + vb + vc);
}

float simplex3(float3 p)
{
    return simplex3_seeded(p, 0u);
}
