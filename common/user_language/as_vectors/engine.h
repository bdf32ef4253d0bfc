// What the predecessor's engine offered to textures, and images as arguments.
#pragma once

#include "common/user_language/as_vectors/vector_functions.h"

typedef struct {
    int number;  // of the scene's texture slots, from 1; 0, what nobody set: white
} sam2D;
typedef sam2D sampler2D;

// The predecessor's handle of a hit, which textures only pass on.
typedef struct SurfaceInfo SurfaceInfo;

// Bits of the last argument of texture2D.
#define TX_FETCH_POINT 0x10000000u
#define TX_FETCH_CLAMP_U 0x40000000u
#define TX_FETCH_CLAMP_V 0x80000000u

typedef struct {
    float3 row[3];
} float3x3;

SHARED float3 tx_to_float3(float4 v) { return TX_NEW(float3, v.x, v.y, v.z); }
SHARED float4 tx_to_float4(float3 v, float w) { return TX_NEW(float4, v.x, v.y, v.z, w); }
SHARED float2 tx_make_float2(float x, float y) { return TX_NEW(float2, x, y); }
SHARED float3 tx_make_float3(float x, float y, float z) { return TX_NEW(float3, x, y, z); }
SHARED float4 tx_make_float4(float x, float y, float z, float w)
{
    return TX_NEW(float4, x, y, z, w);
}
SHARED float3x3 tx_make_float3x3(float3 a, float3 b, float3 c)
{
    float3x3 m;
    m.row[0] = a;
    m.row[1] = b;
    m.row[2] = c;
    return m;
}
SHARED float3 tx_mul3x3x3(float3x3 m, float3 v)
{
    return TX_NEW(float3, tx_dot_float3(m.row[0], v), tx_dot_float3(m.row[1], v),
                  tx_dot_float3(m.row[2], v));
}
