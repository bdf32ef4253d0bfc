// Gradient noise of Perlin, "Improving Noise" (2002): his gradients and his fade of fifth degree,
// whose first and second derivatives are continuous, over hashes instead of a table of 256.
// Values in [-1, 1], mean 0, zero at the lattice points, features one unit apart.

float noise_fade(float t)
{
    return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

// One of the twelve edges of a cube, four of them twice, times (x, y, z).
float edge_gradient3(uint h, float x, float y, float z)
{
    const uint k = h & 15u;
    const float inner = (k & 13u) == 12u ? x : z;
    const float u = k < 8u ? x : y;
    const float v = k < 4u ? y : inner;
    return ((k & 1u) != 0u ? -u : u) + ((k & 2u) != 0u ? -v : v);
}

// One of eight unit vectors, 45 degrees apart, times (x, y).
float octagon_gradient2(uint h, float x, float y)
{
    const float along = (h & 1u) != 0u ? -x : x;
    const float across = (h & 2u) != 0u ? -y : y;
    const float diagonal = (along + across) * 0.707106781f;
    const float straight = (h & 1u) != 0u ? across : ((h & 2u) != 0u ? -x : x);
    return (h & 4u) != 0u ? diagonal : straight;
}

float perlin2_seeded(float2 p, uint seed)
{
    const float x0 = floor(p.x);
    const float y0 = floor(p.y);
    const float x = p.x - x0;
    const float y = p.y - y0;
    const uint s = hash_scramble(seed);
    const uint sum = lattice_sum2((int)x0, (int)y0);
    const uint step_x = lattice_sum2(1, 0);
    const uint step_y = lattice_sum2(0, 1);
    const float v00 = octagon_gradient2(hash_scramble(sum ^ s), x, y);
    const float v10 = octagon_gradient2(hash_scramble((sum + step_x) ^ s), x - 1.0f, y);
    const float v01 = octagon_gradient2(hash_scramble((sum + step_y) ^ s), x, y - 1.0f);
    const float v11 =
        octagon_gradient2(hash_scramble((sum + step_x + step_y) ^ s), x - 1.0f, y - 1.0f);
    const float u = noise_fade(x);
    return 1.41421356f * mix(mix(v00, v10, u), mix(v01, v11, u), noise_fade(y));
}

float perlin2(float2 p)
{
    return perlin2_seeded(p, 0u);
}

// The sum of the weighted gradients is at most 1.03636, which the last factor takes to one.
float perlin3_seeded(float3 p, uint seed)
{
    const float x0 = floor(p.x);
    const float y0 = floor(p.y);
    const float z0 = floor(p.z);
    const float x = p.x - x0;
    const float y = p.y - y0;
    const float z = p.z - z0;
    const float x1 = x - 1.0f;
    const float y1 = y - 1.0f;
    const float z1 = z - 1.0f;
    const uint s = hash_scramble(seed);
    const uint step_x = lattice_sum3(1, 0, 0);
    const uint step_y = lattice_sum3(0, 1, 0);
    const uint near = lattice_sum3((int)x0, (int)y0, (int)z0);
    const uint far = near + lattice_sum3(0, 0, 1);
    const float v000 = edge_gradient3(hash_scramble(near ^ s), x, y, z);
    const float v100 = edge_gradient3(hash_scramble((near + step_x) ^ s), x1, y, z);
    const float v010 = edge_gradient3(hash_scramble((near + step_y) ^ s), x, y1, z);
    const float v110 = edge_gradient3(hash_scramble((near + step_x + step_y) ^ s), x1, y1, z);
    const float v001 = edge_gradient3(hash_scramble(far ^ s), x, y, z1);
    const float v101 = edge_gradient3(hash_scramble((far + step_x) ^ s), x1, y, z1);
    const float v011 = edge_gradient3(hash_scramble((far + step_y) ^ s), x, y1, z1);
    const float v111 = edge_gradient3(hash_scramble((far + step_x + step_y) ^ s), x1, y1, z1);
    const float u = noise_fade(x);
    const float v = noise_fade(y);
    const float front = mix(mix(v000, v100, u), mix(v010, v110, u), v);
    const float back = mix(mix(v001, v101, u), mix(v011, v111, u), v);
    return 0.9649f * mix(front, back, noise_fade(z));
}

float perlin3(float3 p)
{
    return perlin3_seeded(p, 0u);
}
