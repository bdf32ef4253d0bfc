// Sample values: a function of (seed, pixel, sample, dimension) and of nothing else.
//
// Sample s of a pixel belongs to batch (s / n) % 8. Each batch is an Owen-scrambled Sobol sequence
// with a scrambling of its own, so that the spread of batch means measures the real error of the
// picture; n is 16. A render that needs no such measure takes all its samples from one batch (n is
// the power of two that they fit in): where light is smooth, its error falls faster. Dimensions
// come in pairs: each pair is the first two Sobol dimensions, with its own shuffling of the index
// and its own scrambling of the values (Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4),
// 2020), no tables and no loops. The first n samples of a batch continue one sequence from pixel to
// pixel in Morton order (Ahmed and Wonka, "Screen-Space Blue-Noise Diffusion of Monte Carlo
// Sampling Error", 2020), which spreads the error over neighbouring pixels like blue noise; later
// ones follow a sequence of the pixel's own.
#pragma once

#include "platform.h"

#include "common/layout.h"

SHARED uint hash_uint(uint x)
{
    x = (x ^ (x >> 16)) * 0x21f0aaadu;
    x = (x ^ (x >> 15)) * 0x735a2d97u;
    return x ^ (x >> 15);
}

SHARED uint hash_pair(uint a, uint b) { return hash_uint(a ^ (b * 0x9e3779b9u + 0x7f4a7c15u)); }

// Uniform in [0, 1), 24 bits.
SHARED float uniform_from_bits(uint x) { return (float)(int)(x >> 8) * 5.9604644775390625e-8f; }

SHARED uint reverse_bits(uint x)
{
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    return (x >> 16) | (x << 16);
}

// Owen scrambling of a number whose bits are reversed: every bit is flipped by a hash of the bits
// below it (Laine and Karras, with constants by Vegdahl).
SHARED uint owen_scramble_reversed(uint x, uint seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// Bits of the second Sobol dimension, reversed: Pascal's matrix modulo 2 applied by halves.
SHARED uint sobol_second_reversed(uint index)
{
    index ^= index >> 16;
    index ^= (index & 0xff00ff00u) >> 8;
    index ^= (index & 0xf0f0f0f0u) >> 4;
    index ^= (index & 0xccccccccu) >> 2;
    index ^= (index & 0xaaaaaaaau) >> 1;
    return index;
}

SHARED uint spread_bits(uint x)
{
    x &= 0x0000ffffu;
    x = (x | (x << 8)) & 0x00ff00ffu;
    x = (x | (x << 4)) & 0x0f0f0f0fu;
    x = (x | (x << 2)) & 0x33333333u;
    return (x | (x << 1)) & 0x55555555u;
}

SHARED int compact_bits(uint x)
{
    x &= 0x55555555u;
    x = (x | (x >> 1)) & 0x33333333u;
    x = (x | (x >> 2)) & 0x0f0f0f0fu;
    x = (x | (x >> 4)) & 0x00ff00ffu;
    return (int)((x | (x >> 8)) & 0x0000ffffu);
}

SHARED uint morton_code(int x, int y) { return spread_bits((uint)x) | (spread_bits((uint)y) << 1); }

// Where a path stands in its sequence, the same for all its dimensions.
typedef struct {
    uint index;
    uint seed;
} SampleKey;

// pixel: x | y << 16; sequence_quanta: log2(n / 16).
SHARED SampleKey sample_key(uint seed, int sequence_quanta, int pixel, int sample)
{
    const int bits = 4 + sequence_quanta;
    const uint batch = ((uint)sample >> bits) & 7u;
    const uint round = (uint)sample >> (bits + 3);
    const uint within = (uint)sample & ((1u << bits) - 1u);
    const uint shared_seed = hash_pair(seed, batch);
    const uint own_seed = hash_pair(shared_seed, (uint)pixel);
    const uint morton = morton_code(pixel & 0xffff, (int)((uint)pixel >> 16));
    SampleKey key;
    key.index = ((round == 0u ? morton : round) << bits) | within;
    key.seed = round == 0u ? shared_seed : own_seed;
    return key;
}

// One stratified pair in [0, 1)^2, as fractions of 2^32.
typedef struct {
    uint x;
    uint y;
} SampleBits;

SHARED SampleBits sample_bits(SampleKey key, int dimension)
{
    const uint seed = hash_pair(key.seed, (uint)dimension);
    const uint shuffled = reverse_bits(owen_scramble_reversed(reverse_bits(key.index), seed));
    const uint x = owen_scramble_reversed(shuffled, hash_uint(seed ^ 0x68bc21ebu));
    const uint y =
        owen_scramble_reversed(sobol_second_reversed(shuffled), hash_uint(seed ^ 0x02e5be93u));
    SampleBits bits;
    bits.x = reverse_bits(x);
    bits.y = reverse_bits(y);
    return bits;
}

// The same in 24 bits each.
SHARED float2 sample_pair(SampleKey key, int dimension)
{
    const SampleBits bits = sample_bits(key, dimension);
    return make_float2(uniform_from_bits(bits.x), uniform_from_bits(bits.y));
}

// The pairs that a path uses, in order.
#define PAIR_PIXEL_FILTER 0
#define PAIR_FIRST_BOUNCE 1
#define PAIRS_PER_BOUNCE 2
#define PAIR_LIGHT 0    // which light, and which point on it
#define PAIR_SCATTER 1  // direction and lobe

SHARED int bounce_dimension(int depth, int pair)
{
    return PAIR_FIRST_BOUNCE + PAIRS_PER_BOUNCE * depth + pair;
}
