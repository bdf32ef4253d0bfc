// A host of the library's textures that is no renderer: what the texture tool's text asks of one,
// for hits that are given as rows of floats. Read in both dialects, in the types of the user's
// language.
#pragma once

// clang-format off
#define LIBRARY_TEXTURES(ROW) \
    ROW(blend) ROW(brick) ROW(cells) ROW(checker) ROW(fbm) \
    ROW(gabor) ROW(marble) ROW(perlin) ROW(ramp_constant) ROW(ramp_linear) \
    ROW(ramp_smooth) ROW(rust) ROW(scratches) ROW(simplex) ROW(triplanar) \
    ROW(turbulence) ROW(voronoi) ROW(wood) ROW(worley)
// clang-format on

// Floats of a hit: place, normal, texture coordinates, their two differentials, openness.
#define HIT_FLOATS 13

typedef struct TextureContext {
    int budget, fault_line, clamped;
    GLOBAL const uint* words;
    float3 place, normal;
    float2 uv, uv_dx, uv_dy;
    float open;
} TextureContext;

// Float c of hit k of `count`. The plane's start comes first, so that the index is k alone, which
// g++ needs to see neighbours.
SHARED float hit_float(GLOBAL const float* hits, int count, int c, int k)
{
    GLOBAL const float* plane = hits + c * count;
    return plane[k];
}

SHARED TextureContext hit_context(GLOBAL const float* hits, int count, int k,
                                  GLOBAL const uint* words)
{
    TextureContext tx;
    tx.budget = 0;
    tx.fault_line = 0;
    tx.clamped = 0;
    tx.words = words;
    tx.place = TX_NEW(float3, hit_float(hits, count, 0, k), hit_float(hits, count, 1, k),
                      hit_float(hits, count, 2, k));
    tx.normal = TX_NEW(float3, hit_float(hits, count, 3, k), hit_float(hits, count, 4, k),
                       hit_float(hits, count, 5, k));
    tx.uv = TX_NEW(float2, hit_float(hits, count, 6, k), hit_float(hits, count, 7, k));
    tx.uv_dx = TX_NEW(float2, hit_float(hits, count, 8, k), hit_float(hits, count, 9, k));
    tx.uv_dy = TX_NEW(float2, hit_float(hits, count, 10, k), hit_float(hits, count, 11, k));
    tx.open = hit_float(hits, count, 12, k);
    return tx;
}

SHARED uint tx_word(const TextureContext* tx, int word) { return tx->words[word]; }
SHARED float4 tx_stack(const TextureContext* tx, int slot)
{
    return TX_NEW(float4, (float)slot, tx->open, 0.0f, 0.0f);
}
SHARED float3 tx_attribute_LocalPos(const TextureContext* tx) { return tx->place; }
SHARED float3 tx_attribute_WorldPos(const TextureContext* tx) { return tx->place; }
SHARED float3 tx_attribute_Normal(const TextureContext* tx) { return tx->normal; }
SHARED float2 tx_attribute_TexCoord0(const TextureContext* tx) { return tx->uv; }
SHARED float2 tx_attribute_TexCoord0Dx(const TextureContext* tx) { return tx->uv_dx; }
SHARED float2 tx_attribute_TexCoord0Dy(const TextureContext* tx) { return tx->uv_dy; }
SHARED float tx_occlusion(const TextureContext* tx, int request)
{
    return tx->open + 0.0f * (float)request;
}

// An image of smooth colours that repeats.
SHARED float4 tx_sample(const TextureContext* tx, sam2D image, float2 uv)
{
    const float u = tx_fraction_float(uv.x);
    const float v = tx_fraction_float(uv.y);
    return TX_NEW(float4, u, v, u * v, 1.0f + 0.0f * (float)(image.number + tx->budget));
}
