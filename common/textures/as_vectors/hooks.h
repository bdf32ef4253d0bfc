// What user code reads of the renderer, in the types of the user's language: included where these
// and TX_NEW are in scope, in C++ inside their namespace, after common/textures/procedural.h.
#pragma once

SHARED uint tx_word(const TextureContext* tx, int word) { return material_word(tx->scene, word); }

// The result in a slot of the stack.
SHARED float4 tx_stack(const TextureContext* tx, int slot)
{
    const int first = 4 * slot * tx->stack_stride + tx->lane;
    return TX_NEW(float4, tx->stack[first], tx->stack[first + tx->stack_stride],
                  tx->stack[first + 2 * tx->stack_stride], tx->stack[first + 3 * tx->stack_stride]);
}

#define HOOK_float(name, field) \
    SHARED float tx_attribute_##name(const TextureContext* tx) { return tx->field; }
#define HOOK_int(name, field) \
    SHARED int tx_attribute_##name(const TextureContext* tx) { return tx->field; }
#define HOOK_float2(name, field)                                \
    SHARED float2 tx_attribute_##name(const TextureContext* tx) \
    {                                                           \
        return TX_NEW(float2, tx->field.x, tx->field.y);        \
    }
#define HOOK_float3(name, field)                                      \
    SHARED float3 tx_attribute_##name(const TextureContext* tx)       \
    {                                                                 \
        return TX_NEW(float3, tx->field.x, tx->field.y, tx->field.z); \
    }
#define HOOK_float4(name, field)                                                   \
    SHARED float4 tx_attribute_##name(const TextureContext* tx)                    \
    {                                                                              \
        return TX_NEW(float4, tx->field.x, tx->field.y, tx->field.z, tx->field.w); \
    }
#define ATTRIBUTE_HOOK(name, bit, type, field) HOOK_##type(name, field)
TEXTURE_ATTRIBUTES(ATTRIBUTE_HOOK)

SHARED float tx_setting_Time(const TextureContext* tx)
{
    return (float)tx->scene->settings[0].time;
}
SHARED float tx_setting_Frame(const TextureContext* tx)
{
    return math_floor((float)tx->scene->settings[0].time * 24.0f + 0.5f);
}
SHARED float tx_setting_Width(const TextureContext* tx)
{
    return (float)tx->scene->settings[0].width;
}
SHARED float tx_setting_Height(const TextureContext* tx)
{
    return (float)tx->scene->settings[0].height;
}
SHARED float tx_setting_Samples(const TextureContext* tx)
{
    return (float)tx->scene->settings[0].samples;
}

// Linear colour, alpha straight, with the image's own wrapping and filter.
SHARED float4 tx_sample(const TextureContext* tx, sam2D sampler, float2 uv)
{
    const TextureValue texel = texture_texel(tx->scene, sampler.number - 1, uv.x, uv.y);
    return TX_NEW(float4, texel.r, texel.g, texel.b, texel.a);
}

// With the predecessor's flags in place of the image's: TX_FETCH_*.
SHARED float4 tx_sample_flags(const TextureContext* tx, sam2D sampler, float2 uv, uint flags)
{
    const int wrap_u = (flags & TX_FETCH_CLAMP_U) != 0u ? WRAP_CLAMP : WRAP_REPEAT;
    const int wrap_v = (flags & TX_FETCH_CLAMP_V) != 0u ? WRAP_CLAMP : WRAP_REPEAT;
    const int filter = (flags & TX_FETCH_POINT) != 0u ? TEXTURE_NEAREST : TEXTURE_LINEAR;
    const TextureValue texel =
        texture_fetch(tx->scene, sampler.number - 1, uv.x, uv.y, wrap_u + 4 * wrap_v, filter);
    return TX_NEW(float4, texel.r, texel.g, texel.b, texel.a);
}

// The open fraction of a request's rays: 1 where nothing is near.
SHARED float tx_occlusion(const TextureContext* tx, int request)
{
    return get_occlusion_result(tx->paths, tx->first_occlusion + request, tx->path);
}
