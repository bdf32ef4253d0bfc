// Sums of octaves of Perlin's noise, divided by the sum of their weights. `octaves` is from 0 to 8
// and need not be whole: the last one fades in, so that a texture can end at the size of a pixel
// without a jump. `lacunarity` is the ratio of frequencies (about 2), `gain` that of weights (about
// 0.5). Octaves have seeds of their own and are moved against each other, so that their zeros do
// not meet at the lattice points.

// The share of octave i among `octaves`.
float octave_share(float octaves, int i)
{
    return clamp(octaves - (float)i, 0.0f, 1.0f);
}

// Where octave i reads, by a sequence of low discrepancy.
float3 octave_shift(int i)
{
    const float k = (float)i;
    return make_float3(k * 0.819172513f, k * 0.671043607f, k * 0.549700478f);
}

// Fractional Brownian motion, in [-1, 1].
float fbm3_seeded(float3 p, float octaves, float lacunarity, float gain, uint seed)
{
    float sum = 0.0f;
    float total = 0.0f;
    float weight = 1.0f;
    float frequency = 1.0f;
    for (int i = 0; i < 8; ++i) {
        const float share = weight * octave_share(octaves, i);
        const float noise = perlin3_seeded(p * frequency + octave_shift(i), seed + (uint)i);
        sum += share > 0.0f ? share * noise : 0.0f;
        total += share;
        weight *= gain;
        frequency *= lacunarity;
    }
    return sum / fmax(total, 1.0e-6f);
}

float fbm3(float3 p, float octaves, float lacunarity, float gain)
{
    return fbm3_seeded(p, octaves, lacunarity, gain, 0u);
}

// Sum of absolute values (Perlin 1985), in [0, 1]: creased where octaves pass zero.
float turbulence3_seeded(float3 p, float octaves, float lacunarity, float gain, uint seed)
{
    float sum = 0.0f;
    float total = 0.0f;
    float weight = 1.0f;
    float frequency = 1.0f;
    for (int i = 0; i < 8; ++i) {
        const float share = weight * octave_share(octaves, i);
        const float noise = perlin3_seeded(p * frequency + octave_shift(i), seed + (uint)i);
        sum += share > 0.0f ? share * fabs(noise) : 0.0f;
        total += share;
        weight *= gain;
        frequency *= lacunarity;
    }
    return sum / fmax(total, 1.0e-6f);
}

float turbulence3(float3 p, float octaves, float lacunarity, float gain)
{
    return turbulence3_seeded(p, octaves, lacunarity, gain, 0u);
}

// Two and three octaves at ratio 2 and gain 1/2, written out for textures that must be cheap.
float noise3_of_two(float3 p, uint seed)
{
    const float a = perlin3_seeded(p, seed);
    const float b = perlin3_seeded(p * 2.0f + octave_shift(1), seed + 1u);
    return 0.666666667f * a + 0.333333333f * b;
}

float noise3_of_three(float3 p, uint seed)
{
    const float a = perlin3_seeded(p, seed);
    const float b = perlin3_seeded(p * 2.0f + octave_shift(1), seed + 1u);
    const float c = perlin3_seeded(p * 4.0f + octave_shift(2), seed + 2u);
    return 0.571428571f * a + 0.285714286f * b + 0.142857143f * c;
}
