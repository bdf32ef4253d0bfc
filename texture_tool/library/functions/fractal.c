// Sums of octaves of Perlin's noise, divided by the sum of their weights. `octaves` is from 0 to 8
// and need not be whole: the last one fades in, so that a texture can end at the size of a pixel
// without a jump. `lacunarity` is the ratio of frequencies (about 2), `gain` that of weights (about
// 0.5). Octaves have seeds of their own and are moved against each other, so that their zeros do
// not meet at the lattice points.
//
// The octaves are written out rather than looped over or left away, so that loops over paths
// vectorise around them; where their number is known, noise3_of_two and the like cost less.

// The share of octave i among `octaves`: octaves - i, clamped to [0, 1] without a choice, because a
// choice on what all paths share keeps g++ from vectorising the loop over them.
float octave_share(float octaves, int i)
{
    const float rest = octaves - (float)i;
    return 0.5f * (fabs(rest) - fabs(rest - 1.0f) + 1.0f);
}

// Octave i at p times its frequency; moved by a sequence of low discrepancy.
float octave3(float3 p, int i, uint seed)
{
    const float k = (float)i;
    const float3 shift = make_float3(k * 0.819172513f, k * 0.671043607f, k * 0.549700478f);
    return perlin3_seeded(p + shift, seed + (uint)i);
}

// The shares of octaves 0 to 3 and 4 to 7 of weights gain^i.
float4 octave_shares_low(float octaves, float gain)
{
    const float gain2 = gain * gain;
    return make_float4(octave_share(octaves, 0), gain * octave_share(octaves, 1),
                       gain2 * octave_share(octaves, 2), gain2 * gain * octave_share(octaves, 3));
}

float4 octave_shares_high(float octaves, float gain)
{
    const float gain4 = gain * gain * (gain * gain);
    return octave_shares_low(octaves - 4.0f, gain) * gain4;
}

float octave_total(float4 low, float4 high)
{
    return low.x + low.y + low.z + low.w + (high.x + high.y + high.z + high.w) + 1.0e-20f;
}

// Fractional Brownian motion, in [-1, 1].
float fbm3_seeded(float3 p, float octaves, float lacunarity, float gain, uint seed)
{
    const float4 low = octave_shares_low(octaves, gain);
    const float4 high = octave_shares_high(octaves, gain);
    const float l2 = lacunarity * lacunarity;
    const float l4 = l2 * l2;
    float sum = low.x * octave3(p, 0, seed);
    sum += low.y * octave3(p * lacunarity, 1, seed);
    sum += low.z * octave3(p * l2, 2, seed);
    sum += low.w * octave3(p * (l2 * lacunarity), 3, seed);
    sum += high.x * octave3(p * l4, 4, seed);
    sum += high.y * octave3(p * (l4 * lacunarity), 5, seed);
    sum += high.z * octave3(p * (l4 * l2), 6, seed);
    sum += high.w * octave3(p * (l4 * l2 * lacunarity), 7, seed);
    return sum / octave_total(low, high);
}

float fbm3(float3 p, float octaves, float lacunarity, float gain)
{
    return fbm3_seeded(p, octaves, lacunarity, gain, 0u);
}

// Sum of absolute values (Perlin 1985), in [0, 1]: creased where octaves pass zero.
float turbulence3_seeded(float3 p, float octaves, float lacunarity, float gain, uint seed)
{
    const float4 low = octave_shares_low(octaves, gain);
    const float4 high = octave_shares_high(octaves, gain);
    const float l2 = lacunarity * lacunarity;
    const float l4 = l2 * l2;
    float sum = low.x * fabs(octave3(p, 0, seed));
    sum += low.y * fabs(octave3(p * lacunarity, 1, seed));
    sum += low.z * fabs(octave3(p * l2, 2, seed));
    sum += low.w * fabs(octave3(p * (l2 * lacunarity), 3, seed));
    sum += high.x * fabs(octave3(p * l4, 4, seed));
    sum += high.y * fabs(octave3(p * (l4 * lacunarity), 5, seed));
    sum += high.z * fabs(octave3(p * (l4 * l2), 6, seed));
    sum += high.w * fabs(octave3(p * (l4 * l2 * lacunarity), 7, seed));
    return sum / octave_total(low, high);
}

float turbulence3(float3 p, float octaves, float lacunarity, float gain)
{
    return turbulence3_seeded(p, octaves, lacunarity, gain, 0u);
}

// Two, three and four octaves at ratio 2 and gain 1/2.
float noise3_of_two(float3 p, uint seed)
{
    return (octave3(p, 0, seed) + 0.5f * octave3(p * 2.0f, 1, seed)) * 0.666666667f;
}

float noise3_of_three(float3 p, uint seed)
{
    const float two = octave3(p, 0, seed) + 0.5f * octave3(p * 2.0f, 1, seed);
    return (two + 0.25f * octave3(p * 4.0f, 2, seed)) * 0.571428571f;
}

float noise3_of_four(float3 p, uint seed)
{
    const float two = octave3(p, 0, seed) + 0.5f * octave3(p * 2.0f, 1, seed);
    const float three = two + 0.25f * octave3(p * 4.0f, 2, seed);
    return (three + 0.125f * octave3(p * 8.0f, 3, seed)) * 0.533333333f;
}
