// Hashes of lattice points, in integers: every device gives the same bits.
//
// A point's coordinates are summed with odd weights modulo 2^32, so that the sum of a neighbour is
// one addition away; hash_scramble then mixes the sum. The weights are chosen so that points with
// equal sums are far apart: at least 62,900 cells in the planes, 1,659 in space, 275 in four
// dimensions. `seed` gives an independent pattern.

// A bijection of 32 bits in which a change of one bit changes each other bit with a probability
// between 0.47 and 0.53 (the multipliers are Wellons', "Prospecting for Hash Functions").
uint hash_scramble(uint x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

uint lattice_sum2(int x, int y)
{
    return (uint)x * 0xd4449727u + (uint)y * 0x065a4041u;
}

uint lattice_sum3(int x, int y, int z)
{
    return lattice_sum2(x, y) + (uint)z * 0x6a8ac8a7u;
}

uint lattice_sum4(int x, int y, int z, int w)
{
    return lattice_sum3(x, y, z) + (uint)w * 0x465ebe17u;
}

uint hash1(int x, uint seed)
{
    return hash_scramble((uint)x ^ hash_scramble(seed));
}

uint hash2(int x, int y, uint seed)
{
    return hash_scramble(lattice_sum2(x, y) ^ hash_scramble(seed));
}

uint hash3(int x, int y, int z, uint seed)
{
    return hash_scramble(lattice_sum3(x, y, z) ^ hash_scramble(seed));
}

uint hash4(int x, int y, int z, int w, uint seed)
{
    return hash_scramble(lattice_sum4(x, y, z, w) ^ hash_scramble(seed));
}

// The upper 24 bits as a fraction in [0, 1).
float hash_fraction(uint h)
{
    return (float)(int)(h >> 8) * 5.9604644775390625e-8f;
}

// Three fractions in [0, 1), of 11, 11 and 10 bits, at the middles of their steps.
float3 hash_fractions3(uint h)
{
    return make_float3(((float)(int)(h & 2047u) + 0.5f) * 4.8828125e-4f,
                       ((float)(int)((h >> 11) & 2047u) + 0.5f) * 4.8828125e-4f,
                       ((float)(int)(h >> 22) + 0.5f) * 9.765625e-4f);
}

// Two fractions in [0, 1), of 16 bits each, at the middles of their steps.
float2 hash_fractions2(uint h)
{
    return make_float2(((float)(int)(h & 65535u) + 0.5f) * 1.52587890625e-5f,
                       ((float)(int)(h >> 16) + 0.5f) * 1.52587890625e-5f);
}
