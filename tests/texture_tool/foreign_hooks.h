// All that a texture's generated text asks of a host, for hits made of their number: what somebody
// else's renderer would write. Read in both dialects.
#pragma once

typedef struct TextureContext {
    int budget, fault_line, clamped;
    float3 place;
} TextureContext;

SHARED TextureContext foreign_context(int hit)
{
    TextureContext tx;
    tx.budget = 1000;
    tx.fault_line = 0;
    tx.clamped = 0;
    const float k = (float)hit;
    tx.place = TX_NEW(float3, 0.37f * k - 9.0f, 4.0f - 0.11f * k, 0.05f * k * k);
    return tx;
}

// Four words an argument: constant, where it begins, four elements; then values, every other one a
// float or a small integer.
SHARED uint tx_word(const TextureContext* tx, int word)
{
    const int k = word >> 2;
    const int part = word & 3;
    const uint descriptor = part == 0 ? 0xffffffffu : (part == 1 ? (uint)(256 + 16 * k) : 4u);
    const uint number = as_uint(0.25f * (float)(part + 1));
    return word < 256 ? descriptor : number + 0u * (uint)tx->budget;
}
SHARED float4 tx_stack(const TextureContext* tx, int slot)
{
    return TX_NEW(float4, tx->place.x, 0.0f, 0.0f, (float)slot);
}
SHARED float4 tx_sample(const TextureContext* tx, sam2D image, float2 uv)
{
    return TX_NEW(float4, uv.x, uv.y, tx->place.x, (float)(image.number & 3));
}
SHARED float4 tx_sample_flags(const TextureContext* tx, sam2D image, float2 uv, uint flags)
{
    return tx_sample(tx, image, uv) * (float)(flags >> 28);
}
SHARED float tx_occlusion(const TextureContext* tx, int request)
{
    return 0.5f + 0.0f * (tx->place.x + (float)request);
}

#define FOREIGN(type, kind, name, value) \
    SHARED type tx_##kind##_##name(const TextureContext* tx) { return value; }
FOREIGN(float3, attribute, WorldPos, tx->place)
FOREIGN(float3, attribute, LocalPos, tx->place)
FOREIGN(float3, attribute, Normal, TX_NEW(float3, 0.0f, tx->place.x, 1.0f))
FOREIGN(float3, attribute, GeomNormal, TX_NEW(float3, 0.0f, tx->place.x, 1.0f))
FOREIGN(float3, attribute, Tangent, TX_NEW(float3, 1.0f, tx->place.y, 0.0f))
FOREIGN(float3, attribute, Bitangent, TX_NEW(float3, 0.0f, tx->place.y, 1.0f))
FOREIGN(float3, attribute, ViewDir, TX_NEW(float3, 0.0f, tx->place.z, 1.0f))
FOREIGN(float2, attribute, TexCoord0, TX_NEW(float2, tx->place.x, tx->place.y))
FOREIGN(float2, attribute, TexCoord1, TX_NEW(float2, tx->place.y, tx->place.x))
FOREIGN(float2, attribute, TexCoord0Dx, TX_NEW(float2, tx->place.x, 0.0f))
FOREIGN(float2, attribute, TexCoord0Dy, TX_NEW(float2, tx->place.x, 0.0f))
FOREIGN(float4, attribute, VertexColor, TX_NEW(float4, tx->place.x, 1.0f, 1.0f, 1.0f))
FOREIGN(int, attribute, ObjectId, (int)tx->budget)
FOREIGN(int, attribute, InstanceId, (int)tx->budget)
FOREIGN(int, attribute, PrimitiveId, (int)tx->budget)
FOREIGN(float, attribute, Time, tx->place.z)
FOREIGN(float, setting, Time, tx->place.z)
FOREIGN(float, setting, Width, 640.0f + 0.0f * tx->place.z)
